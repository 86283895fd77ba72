// SPDX-License-Identifier: MIT
/// What an open mesh bounds once its openings have lids: each is closed by a fan to the middle of its edge, as for its mass
/// (geometry/mass_moments.hpp). It is a guess at what was meant, and so never a proof that something is inside; but a thing that stays
/// outside of it, and does not come through a lid, is not inside of the body that was meant to be closed.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

struct Closure {
    Matrix3X vertices;                          ///< the mesh's, then the middles of its openings [m]
    std::vector<geometry::Triangle> triangles;  ///< the mesh's, then the lids; without boundary (point_in_solid.hpp)
    std::size_t first_lid = 0;                  ///< where the lids begin
    /// No point of a lid is farther from the edge of its opening, and so from the mesh's surface [m].
    double reach = 0;
};

/// Nothing for a mesh without boundary or without triangles, nor for one that winds round next to nothing with its lids: one whose
/// connected parts are flat sheets, each of them.
std::optional<Closure> closure_of(const geometry::Mesh& mesh);

/// Is the point, in the mesh's frame, where the closure winds round it, or on the closure?
bool is_within(const Vector3& point, const Closure& closure);

/// The lids alone.
geometry::Mesh lids_of(const Closure& closure);

}  // namespace fettle::core::solids
