// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/shells.hpp"

#include <algorithm>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/geometry/point_in_solid.hpp"
#include "fettle/core/geometry/predicates.hpp"

namespace fettle::core::geometry {
namespace {

/// Of two shells that do not cross: is `inner` within `outer`? Asked of a vertex that is not on `outer`; all others are on the same side.
bool lies_within(const Shell& inner, const Shell& outer, const Matrix3X& vertices) {
    for (const int vertex : inner.vertices) {
        if (std::binary_search(outer.vertices.begin(), outer.vertices.end(), vertex)) continue;
        const Vector3 x = vertices.col(vertex);
        return outer.box.contains(x) && point_in_solid(x, vertices, outer.triangles);
    }
    return false;
}

}  // namespace

std::vector<Shell> shells_of(const Mesh& mesh) {
    FETTLE_ASSERT(mesh.triangle_shell.size() == mesh.triangles.size(), "shells need a mesh with connectivity (build_connectivity)");
    std::vector<Shell> shells(mesh.shell_names.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        shells.at(static_cast<std::size_t>(mesh.triangle_shell[t])).triangles.push_back(mesh.triangles[t]);
    for (std::size_t s = 0; s < shells.size(); ++s) {
        Shell& shell = shells[s];
        shell.index = static_cast<int>(s);
        shell.volume_sign = volume_sign(mesh.vertices, shell.triangles);
        for (const Triangle& t : shell.triangles) shell.vertices.insert(shell.vertices.end(), t.begin(), t.end());
        std::sort(shell.vertices.begin(), shell.vertices.end());
        shell.vertices.erase(std::unique(shell.vertices.begin(), shell.vertices.end()), shell.vertices.end());
        const Matrix3X places = mesh.vertices(Eigen::all, shell.vertices);
        shell.box = {places.rowwise().minCoeff(), places.rowwise().maxCoeff()};
    }
    for (Shell& shell : shells) {
        for (const Shell& other : shells) {
            if (other.index == shell.index || !lies_within(shell, other, mesh.vertices)) continue;
            ++shell.depth;
            shell.around = other.index;
        }
    }
    return shells;
}

}  // namespace fettle::core::geometry
