// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mesh.hpp"

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "fettle/core/base/contract.hpp"

namespace fettle::core::geometry {
namespace {

std::uint64_t mixed(std::uint64_t bits) {  // the finaliser of splitmix64: spreads the few changing bits of grid coordinates
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

struct EdgeHash {
    std::size_t operator()(const Edge& edge) const {
        const std::uint64_t low = static_cast<std::uint32_t>(edge[0]);
        const std::uint64_t high = static_cast<std::uint32_t>(edge[1]);
        return static_cast<std::size_t>(mixed(high << 32 | low));
    }
};

using Coordinates = std::array<double, 3>;

struct CoordinatesHash {
    std::size_t operator()(const Coordinates& x) const {
        std::uint64_t hash = 0;
        for (const double value : x) hash = mixed(hash ^ std::bit_cast<std::uint64_t>(value));
        return static_cast<std::size_t>(hash);
    }
};

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

Welding exact_welding(const Matrix3X& vertices) {
    Welding welding;
    welding.new_index.reserve(static_cast<std::size_t>(vertices.cols()));
    std::unordered_map<Coordinates, int, CoordinatesHash> seen;
    seen.reserve(static_cast<std::size_t>(vertices.cols()));
    for (int i = 0; i < vertices.cols(); ++i) {
        // Adding +0 turns -0 into +0; NaN compares unequal to itself, so a NaN vertex is never merged.
        const Coordinates key{vertices(0, i) + 0.0, vertices(1, i) + 0.0, vertices(2, i) + 0.0};
        const auto [place, is_new] = seen.try_emplace(key, static_cast<int>(welding.first_occurrence.size()));
        if (is_new) welding.first_occurrence.push_back(i);
        welding.new_index.push_back(place->second);
    }
    return welding;
}

/// Number of leading `edges` that belong to triangles.
std::size_t triangle_edge_count(const Mesh& mesh) {
    Mesh bare;
    bare.vertices = mesh.vertices;
    bare.triangles = mesh.triangles;
    build_connectivity(bare);
    return bare.edges.size();
}

std::size_t shape_hash(const Mesh& mesh) {
    std::uint64_t hash = mixed(static_cast<std::uint64_t>(mesh.vertices.cols()));
    for (const double x : mesh.vertices.reshaped()) hash = mixed(hash + std::bit_cast<std::uint64_t>(x + 0.0));  // -0 + 0 = 0
    for (const Triangle& t : mesh.triangles)
        for (const int v : t) hash = mixed(hash + static_cast<std::uint64_t>(v));
    return hash;
}

}  // namespace

bool have_same_shape(const Mesh& a, const Mesh& b) {
    return a.vertices.cols() == b.vertices.cols() && a.vertices == b.vertices && a.triangles == b.triangles && a.edges == b.edges &&
           a.codimensional_points == b.codimensional_points;
}

std::size_t ShapeIndex::add(const Mesh& mesh) {
    const std::size_t index = meshes_.size(), hash = shape_hash(mesh);
    meshes_.push_back(&mesh);
    const auto [begin, end] = by_hash_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
        if (have_same_shape(*meshes_[at->second], mesh)) return at->second;
    by_hash_.emplace(hash, index);
    return index;
}

void build_connectivity(Mesh& mesh, const std::vector<Edge>& extra_edges) {
    const int vertex_count = static_cast<int>(mesh.vertices.cols());
    const int triangle_count = static_cast<int>(mesh.triangles.size());
    // Indices that are out of range are left for validate_mesh to report: they must not crash here.
    std::vector<char> used(static_cast<std::size_t>(vertex_count), 0);
    const auto use = [&](int vertex) {
        if (vertex >= 0 && vertex < vertex_count) used[static_cast<std::size_t>(vertex)] = 1;
    };

    mesh.edges.clear();
    std::unordered_map<Edge, int, EdgeHash> first_triangle;
    first_triangle.reserve(3 * mesh.triangles.size() / 2 + extra_edges.size());
    Shells shells(triangle_count);
    for (int t = 0; t < triangle_count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            use(a);
            if (a == b) continue;
            const auto [place, is_new] = first_triangle.try_emplace(ordered(a, b), t);
            if (is_new) {
                mesh.edges.push_back({a, b});
            } else {
                shells.join(place->second, t);
            }
        }
    }
    for (const Edge& edge : extra_edges) {
        if (edge[0] == edge[1] || !first_triangle.try_emplace(ordered(edge[0], edge[1]), -1).second) continue;
        mesh.edges.push_back(edge);
        use(edge[0]);
        use(edge[1]);
    }

    mesh.codimensional_points.clear();
    for (int i = 0; i < vertex_count; ++i) {
        if (!used[static_cast<std::size_t>(i)]) mesh.codimensional_points.push_back(i);
    }

    mesh.triangle_shell.assign(static_cast<std::size_t>(triangle_count), 0);
    int shell_count = 0;
    for (int t = 0; t < triangle_count; ++t) {
        const int first = shells.representative(t);
        mesh.triangle_shell[t] = first == t ? shell_count++ : mesh.triangle_shell[first];
    }
    if (static_cast<int>(mesh.shell_names.size()) != shell_count) {
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
    const Welding welding = exact_welding(mesh.vertices);
    const auto welded = [&](int vertex) {
        FETTLE_ASSERT(vertex >= 0 && vertex < mesh.vertices.cols(), "weld_exactly needs vertex indices in range");
        return welding.new_index[static_cast<std::size_t>(vertex)];
    };

    Mesh result;
    result.name = mesh.name;
    result.vertices.resize(3, static_cast<Eigen::Index>(welding.first_occurrence.size()));
    for (std::size_t i = 0; i < welding.first_occurrence.size(); ++i) {
        result.vertices.col(static_cast<Eigen::Index>(i)) = mesh.vertices.col(welding.first_occurrence[i]);
    }
    for (const Triangle& triangle : mesh.triangles) {
        const Triangle t{welded(triangle[0]), welded(triangle[1]), welded(triangle[2])};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
    }
    std::vector<Edge> extra_edges;
    for (std::size_t e = std::min(triangle_edge_count(mesh), mesh.edges.size()); e < mesh.edges.size(); ++e) {
        extra_edges.push_back({welded(mesh.edges[e][0]), welded(mesh.edges[e][1])});
    }
    result.shell_names = mesh.shell_names;  // kept while the number of shells is the same: welding only joins shells
    build_connectivity(result, extra_edges);
    return result;
}

}  // namespace fettle::core::geometry
