// SPDX-License-Identifier: MIT
#include "core/solids/shells.hpp"

#include <algorithm>
#include <utility>

#include "core/base/contract.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mesh_transforms.hpp"
#include "core/geometry/predicates.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::solids {
namespace {

/// Is `inner` within `outer`, if the two do not cross? Asked of a vertex that is not on `outer`; all others are on the same side.
bool lies_within(const Shell& inner, const Shell& outer, const Matrix3X& vertices) {
    for (const int vertex : inner.vertices) {
        if (std::binary_search(outer.vertices.begin(), outer.vertices.end(), vertex)) continue;
        const Vector3 x = vertices.col(vertex);
        return outer.box.contains(x) && point_in_solid(x, vertices, outer.triangles);
    }
    return false;
}

/// The vertices of the triangles of a shell, in order. @param last_shell  per vertex the last shell that it was found in.
std::vector<int> distinct_vertices(const std::vector<geometry::Triangle>& triangles, std::vector<int>& last_shell, int shell) {
    std::vector<int> out;
    for (const geometry::Triangle& t : triangles) {
        for (const int v : t) {
            if (std::exchange(last_shell[v], shell) != shell) out.push_back(v);
        }
    }
    if (16 * out.size() < last_shell.size()) {
        std::sort(out.begin(), out.end());
        return out;
    }
    out.clear();
    for (std::size_t v = 0; v < last_shell.size(); ++v) {
        if (last_shell[v] == shell) out.push_back(static_cast<int>(v));
    }
    return out;
}

/// Per shell: has an edge of it not as many triangles in one direction as in the other?
std::vector<char> open_shells(const geometry::Mesh& mesh) {
    std::vector<char> is_open(mesh.shell_names.size(), 0);
    const std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    geometry::visit_edges(halves, [&](std::size_t first, std::size_t last) {
        int balance = 0;
        for (std::size_t i = first; i < last; ++i) balance += halves[i].forward ? 1 : -1;
        if (balance != 0 && halves[first].low != halves[first].high) is_open[mesh.triangle_shell[halves[first].triangle]] = 1;
    });
    return is_open;
}

}  // namespace

std::vector<Shell> shells_of(const geometry::Mesh& mesh) {
    FETTLE_ASSERT(mesh.triangle_shell.size() == mesh.triangles.size(), "shells need a mesh with connectivity (build_connectivity)");
    std::vector<Shell> shells(mesh.shell_names.size());
    std::vector<int> last_shell(mesh.vertices.cols(), -1);
    const std::vector<char> is_open = open_shells(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) shells.at(mesh.triangle_shell[t]).triangles.push_back(mesh.triangles[t]);
    for (std::size_t s = 0; s < shells.size(); ++s) {
        Shell& shell = shells[s];
        shell.index = static_cast<int>(s);
        shell.is_closed = is_open[s] == 0;
        shell.volume_sign = geometry::volume_sign(mesh.vertices, shell.triangles);
        shell.vertices = distinct_vertices(shell.triangles, last_shell, shell.index);
        shell.box = {mesh.vertices.col(shell.vertices[0]), mesh.vertices.col(shell.vertices[0])};
        for (const int v : shell.vertices) {
            shell.box.low = shell.box.low.cwiseMin(mesh.vertices.col(v));
            shell.box.high = shell.box.high.cwiseMax(mesh.vertices.col(v));
        }
    }
    std::vector<std::vector<int>> around(shells.size());
    for (Shell& shell : shells) {
        for (const Shell& other : shells) {
            if (other.index == shell.index || !other.is_closed || !lies_within(shell, other, mesh.vertices)) continue;
            ++shell.depth;
            around[shell.index].push_back(other.index);
        }
    }
    const auto is_deeper = [&](int x, int y) { return shells[x].depth < shells[y].depth; };
    for (Shell& shell : shells) {
        const std::vector<int>& list = around[shell.index];
        if (!list.empty()) shell.around = *std::max_element(list.begin(), list.end(), is_deeper);
    }
    return shells;
}

SolidsOfMesh solids_of_shells(const geometry::Mesh& mesh) {
    const std::vector<Shell> shells = shells_of(mesh);
    SolidsOfMesh solids;
    solids.of_shell.assign(shells.size(), -1);
    const auto solid_of = [&](const Shell& shell) {
        const bool may_be_cavity = shell.is_closed && shell.volume_sign < 0 && shell.around >= 0;
        return may_be_cavity && shells[shell.around].volume_sign > 0 ? shell.around : shell.index;
    };
    for (const Shell& shell : shells) {  // the cavity's triangles may come first
        int& of_outer = solids.of_shell[solid_of(shell)];
        if (of_outer < 0) of_outer = solids.count++;
        solids.of_shell[shell.index] = of_outer;
    }
    return solids;
}

std::vector<geometry::Mesh> split_solids(const geometry::Mesh& mesh) {
    if (mesh.triangles.empty()) return {mesh};
    const SolidsOfMesh solids = solids_of_shells(mesh);
    return geometry::split_parts(mesh, solids.of_shell, solids.count);
}

}  // namespace fettle::core::solids
