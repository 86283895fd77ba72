// SPDX-License-Identifier: MIT
#include "core/geometry/body_hierarchy.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>
#include <random>

#include "core/base/parallel.hpp"
#include "tests/core/geometry/sample_meshes.hpp"

namespace fettle::core::geometry::body_hierarchy_test {

namespace {

/// The tree as its definition reads: each list is halved at the median along the longest side of the box of its elements' middles, down to
/// two. Lists of faces, one after the other, in the order of the leaves.
class Halving {
public:
    Halving(const Mesh& mesh, const std::vector<Triangle>& faces) : mesh_(mesh), faces_(faces), order(faces.size()) {
        std::iota(order.begin(), order.end(), 0);
        split(0, count_of(order));
    }

private:
    Vector3 middle(int face) const {
        const Matrix3 x = mesh_.vertices(Eigen::all, faces_[face]);
        return 0.5 * (x.rowwise().minCoeff() + x.rowwise().maxCoeff());
    }
    void split(int first, int count) {
        parts.push_back({first, count});
        if (count <= 2) return;
        Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (int i = first; i < first + count; ++i) {
            low = low.cwiseMin(middle(order[i]));
            high = high.cwiseMax(middle(order[i]));
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const int half = count / 2;
        std::nth_element(order.begin() + first, order.begin() + first + half, order.begin() + first + count, [&](int a, int b) {
            const double ca = middle(a)[axis], cb = middle(b)[axis];
            return ca != cb ? ca < cb : a < b;
        });
        split(first, half);
        split(first + half, count - half);
    }

    const Mesh& mesh_;
    const std::vector<Triangle>& faces_;

public:
    std::vector<int> order;
    std::vector<std::pair<int, int>> parts;  ///< first, count: in the order of the nodes
};

bool is_same(const HierarchyNode& a, const HierarchyNode& b) {
    return a.center == b.center && a.half_extent == b.half_extent && a.radius == b.radius && a.left == b.left && a.right == b.right &&
           a.first == b.first && a.count == b.count;
}

}  // namespace

TEST_CASE("a hierarchy is that of its definition, node for node") {
    std::mt19937_64 random(1);
    for (const int n : {3, 4, 5, 7, 12, 33, 60}) {
        Mesh mesh = tests::torus_mesh(1, 0.4, n);
        mesh.vertices += 0.01 * tests::random_matrix(static_cast<int>(mesh.vertices.cols()), random);
        if (n == 12) mesh.vertices = (8 * mesh.vertices).array().round().matrix();  // many middles in one place
        const BodyHierarchy hierarchy(mesh);
        const Halving halving(mesh, hierarchy.faces());
        REQUIRE(hierarchy.nodes().size() == halving.parts.size());
        REQUIRE(hierarchy.elements().size() == mesh.triangles.size());
        bool same_elements = true, same_parts = true, tight = true;
        for (std::size_t i = 0; i < halving.order.size(); ++i)
            same_elements = same_elements && hierarchy.elements()[i].face == halving.order[i];
        for (std::size_t i = 0; i < halving.parts.size(); ++i) {
            const HierarchyNode& node = hierarchy.nodes()[i];
            same_parts = same_parts && std::pair(node.first, node.count) == halving.parts[i];
            if (!node.is_leaf()) {
                const HierarchyNode &left = hierarchy.nodes()[node.left], &right = hierarchy.nodes()[node.right];
                same_parts = same_parts && left.first == node.first && right.first == left.first + left.count &&
                             left.count + right.count == node.count;
            }
            Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
            double radius = 0;
            for (int e = node.first; e < node.first + node.count; ++e) {
                for (const int v : hierarchy.elements()[e].vertices) {
                    low = low.cwiseMin(mesh.vertices.col(v));
                    high = high.cwiseMax(mesh.vertices.col(v));
                    radius = std::max(radius, mesh.vertices.col(v).norm());
                }
            }
            const Vector3 half = (high - node.center).cwiseMax(node.center - low);
            tight = tight && node.center == 0.5 * (low + high) && (node.half_extent.array() >= half.array()).all() &&
                    (node.half_extent - half).maxCoeff() <= 1e-15 * half.maxCoeff() && node.radius >= radius &&
                    node.radius < radius * (1 + 1e-14);
        }
        CHECK(same_elements);
        CHECK(same_parts);
        CHECK(tight);
    }
}

TEST_CASE("a hierarchy has the same bits for any number of threads") {
    const Mesh mesh = tests::torus_mesh(1, 0.4, 100);  // large enough to be built in parts
    const BodyHierarchy several(mesh);
    const base::ThreadLimit limit(1);
    const BodyHierarchy one(mesh);
    CHECK(std::equal(one.nodes().begin(), one.nodes().end(), several.nodes().begin(), several.nodes().end(), is_same));
    CHECK(std::equal(
        one.elements().begin(), one.elements().end(), several.elements().begin(), several.elements().end(),
        [](const HierarchyElement& a, const HierarchyElement& b) { return a.face == b.face && a.owned_edges == b.owned_edges; }));
}

TEST_CASE("each vertex and each edge has one owner that contains it") {
    Mesh mesh = tests::torus_mesh(1, 0.4, 9);
    mesh.vertices.conservativeResize(3, 84);
    mesh.vertices.rightCols(3).setConstant(4);
    build_connectivity(mesh, {{0, 81}, {81, 82}});
    const BodyHierarchy hierarchy(mesh);
    std::vector<int> vertex_owners(84, 0), edge_owners(mesh.edges.size(), 0);
    for (const HierarchyElement& element : hierarchy.elements()) {
        for (int k = 0; k < element.owned_vertex_count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            ++vertex_owners[element.owned_vertices[at]];
            CHECK(element.vertices[element.owned_vertex_corner[at]] == element.owned_vertices[at]);
        }
        for (int k = 0; k < element.owned_edge_count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const Edge& edge = mesh.edges[element.owned_edges[at]];
            ++edge_owners[element.owned_edges[at]];
            for (std::size_t end = 0; end < 2; ++end) CHECK(element.vertices[element.owned_edge_corners[at][end]] == edge[end]);
        }
    }
    CHECK(std::all_of(vertex_owners.begin(), vertex_owners.end(), [](int n) { return n == 1; }));
    CHECK(std::all_of(edge_owners.begin(), edge_owners.end(), [](int n) { return n == 1; }));
}

namespace {

bool holds(const OwnedBox& box, const Vector3& x) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double at = x[static_cast<int>(k)];
        if (!(box.low[k] <= at && at <= box.high[k])) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("boxes of owned vertices and edges hold them, and little more") {
    Mesh mesh = tests::torus_mesh(1, 0.4, 8);
    mesh.vertices.conservativeResize(3, mesh.vertices.cols() + 4);
    mesh.vertices.rightCols(4) << 2, 3, 3, 2, 0, 0, 1, 1, 0.1, 0.1, 0.1, 0.1;  // a plane square
    const int v = static_cast<int>(mesh.vertices.cols()) - 4;
    mesh.triangles.push_back({v, v + 1, v + 2});
    mesh.triangles.push_back({v, v + 2, v + 3});
    build_connectivity(mesh, {});
    const FlatFeatures flat = flat_features(mesh, 1e-6);
    const BodyHierarchy hierarchy(mesh, &flat);
    CHECK(BodyHierarchy(mesh).edge_boxes().empty());
    REQUIRE(hierarchy.vertex_boxes().size() == hierarchy.nodes().size());
    REQUIRE(hierarchy.edge_boxes().size() == hierarchy.nodes().size());
    int plane_edges = 0;
    for (std::size_t i = 0; i < hierarchy.nodes().size(); ++i) {
        const HierarchyNode& node = hierarchy.nodes()[i];
        const OwnedBox &vertices = hierarchy.vertex_boxes()[i], &edges = hierarchy.edge_boxes()[i];
        std::vector<Vector3> points, ends;
        for (int e = node.first; e < node.first + node.count; ++e) {
            const HierarchyElement& element = hierarchy.elements()[static_cast<std::size_t>(e)];
            for (int k = 0; k < element.owned_vertex_count; ++k)
                points.emplace_back(mesh.vertices.col(element.owned_vertices[static_cast<std::size_t>(k)]));
            for (int k = 0; k < element.owned_edge_count; ++k) {
                const int edge = element.owned_edges[static_cast<std::size_t>(k)];
                plane_edges += flat.is_plane_edge(edge) && node.is_leaf();
                if (flat.is_plane_edge(edge)) continue;
                for (const int end : mesh.edges[static_cast<std::size_t>(edge)]) ends.emplace_back(mesh.vertices.col(end));
            }
        }
        for (const auto& [box, all] : {std::pair(vertices, points), std::pair(edges, ends)}) {
            CHECK(box.is_empty() == all.empty());
            CHECK(std::all_of(all.begin(), all.end(), [&box = box](const Vector3& x) { return holds(box, x); }));
            for (int k = 0; k < 3 && !all.empty(); ++k) {
                double low = all[0][k], high = all[0][k];
                for (const Vector3& x : all) {
                    low = std::min(low, x[k]);
                    high = std::max(high, x[k]);
                }
                CHECK(box.low[static_cast<std::size_t>(k)] >= low - 1e-6);
                CHECK(box.high[static_cast<std::size_t>(k)] <= high + 1e-6);
            }
        }
    }
    CHECK(plane_edges == 8 * 8 + 1);  // the torus's facets are plane, too
}

}  // namespace fettle::core::geometry::body_hierarchy_test
