// SPDX-License-Identifier: MIT
// And of mesh.hpp: edges, points and shells from triangles.
#include "core/geometry/connectivity.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/mixed_bits.hpp"
#include "core/geometry/half_edges.hpp"

namespace fettle::core::geometry {
namespace {

Edge ordered(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Union-find over triangles, with the smallest triangle as the representative of its shell.
class Shells {
public:
    explicit Shells(int count) : parent_(static_cast<std::size_t>(count)) {
        for (int i = 0; i < count; ++i) parent_[i] = i;
    }
    int representative(int i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(int i, int j) {
        i = representative(i);
        j = representative(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<int> parent_;
};

/// For each vertex the index among the distinct ones, which are numbered in the order of first occurrence.
struct Welding {
    std::vector<int> new_index;
    std::vector<int> first_occurrence;
};

/// A table of the distinct vertices, open addressing: half of it stays free.
Welding exact_welding(const Matrix3X& vertices) {
    const auto count = static_cast<std::size_t>(vertices.cols());
    Welding welding;
    welding.new_index.reserve(count);
    welding.first_occurrence.reserve(count);
    const std::size_t mask = std::bit_ceil(2 * count + 2) - 1;
    std::vector<int> table(mask + 1, -1);
    for (int i = 0; i < vertices.cols(); ++i) {
        const Vector3 x = vertices.col(i);
        // Adding +0 turns -0 into +0; NaN compares unequal to itself, so a NaN vertex is never merged.
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k) hash = base::mixed_bits(hash ^ std::bit_cast<std::uint64_t>(x[k] + 0.0));
        std::size_t place = static_cast<std::size_t>(hash) & mask;
        const auto is_other = [&](int distinct) { return vertices.col(welding.first_occurrence[distinct]) != x; };
        while (table[place] >= 0 && is_other(table[place])) place = (place + 1) & mask;
        if (table[place] < 0) {
            table[place] = count_of(welding.first_occurrence);
            welding.first_occurrence.push_back(i);
        }
        welding.new_index.push_back(table[place]);
    }
    return welding;
}

/// Those of `extra` that are between two vertices and neither among `known` nor listed before.
std::vector<Edge> fresh_edges(const std::vector<Edge>& known, const std::vector<Edge>& extra) {
    std::vector<Edge> fresh;
    if (extra.empty()) return fresh;
    const EdgeIndex index(known);
    std::set<Edge> seen;
    for (const Edge& edge : extra) {
        if (edge[0] == edge[1] || index.find(edge[0], edge[1]) >= 0 || !seen.insert(ordered(edge[0], edge[1])).second) continue;
        fresh.push_back(edge);
    }
    return fresh;
}

/// @param shell_names  Kept while the number of shells is the same.
Mesh welded(std::string name, std::vector<std::string> shell_names, const Matrix3X& vertices, const std::vector<Triangle>& triangles,
            const std::vector<Edge>& edges) {
    const Welding welding = exact_welding(vertices);
    const auto merged = [&](int vertex) {
        FETTLE_ASSERT(vertex >= 0 && vertex < vertices.cols(), "welding needs vertex indices in range");
        return welding.new_index[vertex];
    };
    Mesh result;
    result.name = std::move(name);
    result.shell_names = std::move(shell_names);
    result.vertices.resize(3, welding.first_occurrence.size());
    for (std::size_t i = 0; i < welding.first_occurrence.size(); ++i) result.vertices.col(i) = vertices.col(welding.first_occurrence[i]);
    result.triangles.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
        const Triangle t{merged(triangle[0]), merged(triangle[1]), merged(triangle[2])};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
    }
    std::vector<Edge> extra_edges;
    extra_edges.reserve(edges.size());
    for (const Edge& edge : edges) extra_edges.push_back({merged(edge[0]), merged(edge[1])});
    build_connectivity(result, extra_edges);
    return result;
}

}  // namespace

void build_connectivity(Mesh& mesh, const std::vector<Edge>& extra_edges) {
    const int vertex_count = static_cast<int>(mesh.vertices.cols());
    const int triangle_count = count_of(mesh.triangles);
    // Indices that are out of range are left for validate_mesh to report: they must not crash here.
    std::vector<char> used(vertex_count, 0);
    const auto use = [&](int vertex) {
        if (vertex >= 0 && vertex < vertex_count) used[vertex] = 1;
    };

    TriangleEdges found = triangle_edges(mesh.triangles);
    Shells shells(triangle_count);
    std::vector<int> first_triangle(found.edges.size(), -1);
    for (int t = 0; t < triangle_count; ++t) {
        for (int k = 0; k < 3; ++k) {
            use(mesh.triangles[t][k]);
            const int edge = found.of_side[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k)];
            if (edge < 0) continue;
            if (first_triangle[edge] < 0) {
                first_triangle[edge] = t;
            } else {
                shells.join(first_triangle[edge], t);
            }
        }
    }
    mesh.edges = std::move(found.edges);
    for (const Edge& edge : fresh_edges(mesh.edges, extra_edges)) {
        mesh.edges.push_back(edge);
        use(edge[0]);
        use(edge[1]);
    }

    mesh.codimensional_points.clear();
    for (int i = 0; i < vertex_count; ++i) {
        if (!used[i]) mesh.codimensional_points.push_back(i);
    }

    mesh.triangle_shell.assign(triangle_count, 0);
    int shell_count = 0;
    for (int t = 0; t < triangle_count; ++t) {
        const int first = shells.representative(t);
        mesh.triangle_shell[t] = first == t ? shell_count++ : mesh.triangle_shell[first];
    }
    if (count_of(mesh.shell_names) != shell_count) {
        mesh.shell_names.clear();
        for (int s = 0; s < shell_count; ++s) mesh.shell_names.push_back(mesh.name + "/" + std::to_string(s));
    }
}

Mesh make_mesh(std::string name, Matrix3X vertices, std::vector<Triangle> triangles) {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.vertices = std::move(vertices);
    mesh.triangles = std::move(triangles);
    build_connectivity(mesh);
    return mesh;
}

Mesh weld_exactly(const Mesh& mesh) {
    const auto of_triangles = std::min(triangle_edges(mesh.triangles).edges.size(), mesh.edges.size());
    const std::vector<Edge> others(mesh.edges.begin() + static_cast<std::ptrdiff_t>(of_triangles), mesh.edges.end());
    return welded(mesh.name, mesh.shell_names, mesh.vertices, mesh.triangles, others);  // welding only joins shells
}

Mesh welded_mesh(std::string name, const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Edge>& edges) {
    return welded(std::move(name), {}, vertices, triangles, edges);
}

}  // namespace fettle::core::geometry
