// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/body_hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "fettle/core/base/contract.hpp"

namespace fettle::core::geometry {
namespace {

constexpr int leaf_size = 2;

double rounded_up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }

void name_corners(const geometry::Mesh& mesh, HierarchyElement& element) {
    const auto corner = [&](int v) {
        return static_cast<int>(std::find(element.vertices.begin(), element.vertices.end(), v) - element.vertices.begin());
    };
    for (int k = 0; k < element.owned_vertex_count; ++k) element.owned_vertex_corner[k] = corner(element.owned_vertices[k]);
    for (int k = 0; k < element.owned_edge_count; ++k) {
        const geometry::Edge& edge = mesh.edges[element.owned_edges[k]];
        element.owned_edge_corners[k] = {corner(edge[0]), corner(edge[1])};
    }
}

// Every vertex and edge goes to the first element that contains it.
std::vector<HierarchyElement> collect_elements(const geometry::Mesh& mesh) {
    std::vector<HierarchyElement> elements;
    std::vector<bool> vertex_owned(static_cast<std::size_t>(mesh.vertices.cols()), false);
    std::map<std::pair<int, int>, int> edge_index;
    for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) edge_index[std::minmax(mesh.edges[e][0], mesh.edges[e][1])] = e;
    std::vector<bool> edge_owned(mesh.edges.size(), false);
    const auto own_vertex = [&](HierarchyElement& element, int v) {
        if (vertex_owned[v]) return;
        vertex_owned[v] = true;
        element.owned_vertices[element.owned_vertex_count++] = v;
    };
    const auto own_edge = [&](HierarchyElement& element, int e) {
        if (edge_owned[e]) return;
        edge_owned[e] = true;
        element.owned_edges[element.owned_edge_count++] = e;
    };
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
        HierarchyElement element;
        element.triangle = t;
        element.vertex_count = 3;
        element.vertices = mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            own_vertex(element, mesh.triangles[t][k]);
            const auto edge = edge_index.find(std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
            FETTLE_ASSERT(edge != edge_index.end(), "mesh " + mesh.name + " has a triangle whose edge is not listed");
            own_edge(element, edge->second);
        }
        elements.push_back(element);
    }
    for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
        if (edge_owned[e]) continue;
        HierarchyElement element;
        element.vertex_count = 2;
        element.vertices = {mesh.edges[e][0], mesh.edges[e][1], -1};
        own_vertex(element, mesh.edges[e][0]);
        own_vertex(element, mesh.edges[e][1]);
        own_edge(element, e);
        elements.push_back(element);
    }
    for (int v = 0; v < static_cast<int>(mesh.vertices.cols()); ++v) {
        if (vertex_owned[v]) continue;
        HierarchyElement element;
        element.vertex_count = 1;
        element.vertices = {v, -1, -1};
        own_vertex(element, v);
        elements.push_back(element);
    }
    for (int i = 0; i < static_cast<int>(elements.size()); ++i) {
        elements[i].face = i;
        name_corners(mesh, elements[i]);
    }
    return elements;
}

std::vector<geometry::Triangle> faces_of(const std::vector<HierarchyElement>& elements) {
    std::vector<geometry::Triangle> faces;
    for (const HierarchyElement& e : elements) {
        const auto& v = e.vertices;
        faces.push_back({v[0], e.vertex_count > 1 ? v[1] : v[0], e.vertex_count > 2 ? v[2] : e.vertex_count > 1 ? v[1] : v[0]});
    }
    return faces;
}

struct Box {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
    Vector3 high = -low;
    double radius_squared = 0;
    void add(const Vector3& x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
        radius_squared = std::max(radius_squared, x.squaredNorm());
    }
};

class Builder {
public:
    Builder(const geometry::Mesh& mesh, std::vector<HierarchyElement>& elements, std::vector<HierarchyNode>& nodes)
        : mesh_(mesh), elements_(elements), nodes_(nodes) {
        for (const HierarchyElement& element : elements_) centroids_.push_back(centroid(element));
        order_.resize(elements_.size());
        std::iota(order_.begin(), order_.end(), 0);
    }

    void build() {
        nodes_.reserve(2 * elements_.size());
        split(0, static_cast<int>(order_.size()));
        std::vector<HierarchyElement> sorted;
        sorted.reserve(elements_.size());
        for (int i : order_) sorted.push_back(elements_[i]);
        elements_ = std::move(sorted);
    }

private:
    Vector3 centroid(const HierarchyElement& element) const {
        Box box;
        for (int k = 0; k < element.vertex_count; ++k) box.add(mesh_.vertices.col(element.vertices[k]));
        return 0.5 * (box.low + box.high);
    }

    Box bounds(int first, int count) const {
        Box box;
        for (int i = first; i < first + count; ++i) {
            const HierarchyElement& element = elements_[order_[i]];
            for (int k = 0; k < element.vertex_count; ++k) box.add(mesh_.vertices.col(element.vertices[k]));
        }
        return box;
    }

    int split(int first, int count) {
        const int index = static_cast<int>(nodes_.size());
        nodes_.emplace_back();
        const Box box = bounds(first, count);
        HierarchyNode node;
        node.center = 0.5 * (box.low + box.high);
        for (int k = 0; k < 3; ++k) {
            const double half = std::max(box.high[k] - node.center[k], node.center[k] - box.low[k]);
            node.half_extent[k] = half > 0 ? rounded_up(half) : 0;
        }
        node.radius = rounded_up(std::sqrt(box.radius_squared) * (1 + 4 * std::numeric_limits<double>::epsilon()));
        node.first = first;
        node.count = count;
        if (count > leaf_size) {
            const int half = partition(first, count);
            node.left = split(first, half);
            node.right = split(first + half, count - half);
        }
        nodes_[index] = node;
        return index;
    }

    // Median of the centroids along their longest extent; ties by index, so the tree is a pure function of the mesh.
    int partition(int first, int count) {
        Box box;
        for (int i = first; i < first + count; ++i) box.add(centroids_[order_[i]]);
        int axis = 0;
        (box.high - box.low).maxCoeff(&axis);
        const int half = count / 2;
        std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count, [&](int a, int b) {
            const double ca = centroids_[a][axis], cb = centroids_[b][axis];
            return ca != cb ? ca < cb : a < b;
        });
        return half;
    }

    const geometry::Mesh& mesh_;
    std::vector<HierarchyElement>& elements_;
    std::vector<HierarchyNode>& nodes_;
    std::vector<Vector3> centroids_;
    std::vector<int> order_;
};

}  // namespace

BodyHierarchy::BodyHierarchy(const geometry::Mesh& mesh) : elements_(collect_elements(mesh)), faces_(faces_of(elements_)) {
    FETTLE_ASSERT(!elements_.empty(), "mesh " + mesh.name + " has no vertices");
    FETTLE_ASSERT(mesh.vertices.allFinite(), "mesh " + mesh.name + " has a vertex that is not finite");
    Builder(mesh, elements_, nodes_).build();
}

}  // namespace fettle::core::geometry
