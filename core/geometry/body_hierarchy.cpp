// SPDX-License-Identifier: MIT
#include "core/geometry/body_hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/contract.hpp"
#include "core/base/float_rounding.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/half_edges.hpp"

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
    std::vector<bool> vertex_owned(mesh.vertices.cols(), false);
    elements.reserve(mesh.triangles.size());
    const EdgeIndex edge_index(mesh.edges);
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
    for (int t = 0; t < count_of(mesh.triangles); ++t) {
        HierarchyElement element;
        element.triangle = t;
        element.vertex_count = 3;
        element.vertices = mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            own_vertex(element, mesh.triangles[t][k]);
            const int edge = edge_index.find(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
            FETTLE_ASSERT(edge >= 0, "mesh " + mesh.name + " has a triangle whose edge is not listed");
            own_edge(element, edge);
        }
        elements.push_back(element);
    }
    for (int e = 0; e < count_of(mesh.edges); ++e) {
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
    for (int i = 0; i < count_of(elements); ++i) {
        elements[i].face = i;
        name_corners(mesh, elements[i]);
    }
    return elements;
}

std::vector<geometry::Triangle> faces_of(const std::vector<HierarchyElement>& elements) {
    std::vector<geometry::Triangle> faces;
    faces.reserve(elements.size());
    for (const HierarchyElement& e : elements) {
        const auto& v = e.vertices;
        faces.push_back({v[0], e.vertex_count > 1 ? v[1] : v[0], e.vertex_count > 2 ? v[2] : e.vertex_count > 1 ? v[1] : v[0]});
    }
    return faces;
}

struct Bounds {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
    Vector3 high = -low;
    double radius_squared = 0;

    void add(const Vector3& x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
        radius_squared = std::max(radius_squared, x.squaredNorm());
    }
    void add(const Bounds& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
        radius_squared = std::max(radius_squared, other.radius_squared);
    }
};

/// Halves a list of elements again and again. Where a part stands in the list, and its nodes among all, follows from the numbers of
/// elements alone: parts that are large enough are built side by side, with the same result.
class Builder {
public:
    Builder(const geometry::Mesh& mesh, std::vector<HierarchyElement>& elements, std::vector<HierarchyNode>& nodes)
        : mesh_(mesh), elements_(elements), nodes_(nodes) {}

    void build() {
        items_.resize(elements_.size());
        base::parallel_for(count(), grain, [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            items_[at] = {centroid(elements_[at]), i};
        });
        count_nodes();
        nodes_.resize(nodes_of(0, count()));
        split({0, 0, 0, count()});
        std::vector<HierarchyElement> sorted(elements_.size());
        base::parallel_for(count(), grain, [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            sorted[at] = elements_[items_[at].element];
        });
        elements_ = std::move(sorted);
    }

private:
    struct Item {
        Vector3 centroid;
        int element;
    };
    struct Part {
        int node, depth, first, count;
    };
    static constexpr int grain = 4096;  ///< elements that one thread takes at least

    int count() const { return count_of(elements_); }

    /// At each depth parts have the number of all elements divided by 2^depth, rounded down, or one more.
    void count_nodes() {
        int depth = 0;
        while ((count() >> depth) > leaf_size) ++depth;
        node_counts_.resize(static_cast<std::size_t>(depth) + 1);
        for (; depth >= 0; --depth) {
            for (int more = 0; more < 2; ++more) {
                const int size = (count() >> depth) + more, half = size / 2;
                node_counts_[depth][more] = size <= leaf_size ? 1 : 1 + nodes_of(depth + 1, half) + nodes_of(depth + 1, size - half);
            }
        }
    }
    int nodes_of(int depth, int size) const {
        if (size <= leaf_size) return 1;
        return node_counts_[depth][size - (count() >> depth)];
    }

    Vector3 centroid(const HierarchyElement& element) const {
        Bounds box;
        for (int k = 0; k < element.vertex_count; ++k) box.add(Vector3(mesh_.vertices.col(element.vertices[k])));
        return 0.5 * (box.low + box.high);
    }

    Bounds leaf_bounds(const Part& part) const {
        Bounds box;
        for (int i = part.first; i < part.first + part.count; ++i) {
            const HierarchyElement& element = elements_[items_[i].element];
            for (int k = 0; k < element.vertex_count; ++k) box.add(Vector3(mesh_.vertices.col(element.vertices[k])));
        }
        return box;
    }

    Bounds split(const Part& part) {
        HierarchyNode& node = nodes_[part.node];
        node.first = part.first;
        node.count = part.count;
        Bounds box;
        if (part.count <= leaf_size) {
            box = leaf_bounds(part);
        } else {
            const int half = partition(part), depth = part.depth + 1;
            node.left = part.node + 1;
            node.right = node.left + nodes_of(depth, half);
            const std::array<Part, 2> halves{Part{node.left, depth, part.first, half},
                                             Part{node.right, depth, part.first + half, part.count - half}};
            std::array<Bounds, 2> boxes;
            const auto split_half = [&](int k) { boxes[k] = split(halves[k]); };
            if (part.count > grain) {
                base::parallel_for(2, 1, split_half);
            } else {
                split_half(0);
                split_half(1);
            }
            box = boxes[0];
            box.add(boxes[1]);
        }
        node.center = 0.5 * (box.low + box.high);
        for (int k = 0; k < 3; ++k) {
            const double half = std::max(box.high[k] - node.center[k], node.center[k] - box.low[k]);
            node.half_extent[k] = half > 0 ? rounded_up(half) : 0;
        }
        node.radius = rounded_up(std::sqrt(box.radius_squared) * (1 + 4 * std::numeric_limits<double>::epsilon()));
        return box;
    }

    // Median of the centroids along their longest extent; ties by index, so the tree is a pure function of the mesh.
    int partition(const Part& part) {
        Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        const auto first = items_.begin() + part.first, last = first + part.count;
        for (auto item = first; item != last; ++item) {
            low = low.cwiseMin(item->centroid);
            high = high.cwiseMax(item->centroid);
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const int half = part.count / 2;
        std::nth_element(first, first + half, last, [axis](const Item& a, const Item& b) {
            const double ca = a.centroid[axis], cb = b.centroid[axis];
            return ca != cb ? ca < cb : a.element < b.element;
        });
        return half;
    }

    const geometry::Mesh& mesh_;
    std::vector<HierarchyElement>& elements_;
    std::vector<HierarchyNode>& nodes_;
    std::vector<Item> items_;
    std::vector<std::array<int, 2>> node_counts_;  ///< per depth, of a part of the smaller and of the larger number of elements
};

void widen(OwnedBox& box, const OwnedBox& by) {
    for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], by.low[k]);
        box.high[k] = std::max(box.high[k], by.high[k]);
    }
}

void widen(OwnedBox& box, const Vector3& by) {
    OwnedBox point;
    for (std::size_t k = 0; k < 3; ++k) {
        point.low[k] = base::float_below(by[static_cast<int>(k)]);
        point.high[k] = base::float_above(by[static_cast<int>(k)]);
    }
    widen(box, point);
}

// The boxes of the nodes' elements, by add(element, box) each; children come after their parents.
template <class Add>
std::vector<OwnedBox> owned_boxes(const std::vector<HierarchyNode>& nodes, const std::vector<HierarchyElement>& elements, const Add& add) {
    std::vector<OwnedBox> boxes(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const HierarchyNode& node = nodes[i];
        if (node.is_leaf()) {
            for (int k = node.first; k < node.first + node.count; ++k) add(elements[k], boxes[i]);
        } else {
            for (const int child : {node.left, node.right}) widen(boxes[i], boxes[child]);
        }
    }
    return boxes;
}

}  // namespace

BodyHierarchy::BodyHierarchy(const geometry::Mesh& mesh, const FlatFeatures* flat)
    : elements_(collect_elements(mesh)), faces_(faces_of(elements_)) {
    FETTLE_ASSERT(!elements_.empty(), "mesh " + mesh.name + " has no vertices");
    FETTLE_ASSERT(mesh.vertices.allFinite(), "mesh " + mesh.name + " has a vertex that is not finite");
    Builder(mesh, elements_, nodes_).build();
    vertex_boxes_ = owned_boxes(nodes_, elements_, [&](const HierarchyElement& element, OwnedBox& box) {
        for (int k = 0; k < element.owned_vertex_count; ++k) widen(box, mesh.vertices.col(element.owned_vertices[k]));
    });
    if (flat == nullptr) return;
    edge_boxes_ = owned_boxes(nodes_, elements_, [&](const HierarchyElement& element, OwnedBox& box) {
        for (int k = 0; k < element.owned_edge_count; ++k)
            if (const int e = element.owned_edges[k]; !flat->is_plane_edge(e))
                for (const int v : mesh.edges[e]) widen(box, mesh.vertices.col(v));
    });
}

}  // namespace fettle::core::geometry
