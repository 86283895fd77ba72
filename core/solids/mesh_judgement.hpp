// SPDX-License-Identifier: MIT
/// Can a real mesh be used, and what is odd about it? Where mesh_validity.hpp asks for a perfect solid, this takes what does no harm to a
/// rigid body, which never collides with itself, and reports it: number, place, and a bound of its effect on the mass.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

struct MeshFindings {
    Errors errors;                      ///< why it cannot be used; `where` is "<mesh name>: triangle 12" and the like
    std::vector<std::string> warnings;  ///< one sentence per kind
};

/// Errors: vertices that are not finite, indices out of range; of a solid also: openings too large to cap (is_nearly_closed), triangles
/// turned over, no positive volume. Warnings: triangles without area, edges of more than two triangles, loose edges and points, openings
/// (capped for the mass), triangles that intersect, solids within solids.
/// @param as_solid  Its mass is that of the volume that it encloses. Else (static bodies, shells, wires) nothing is said of mass; solids
///                  within solids are reported all the same, if the mesh is closed: they decide what is inside.
/// Contract: connectivity built, unless indices are out of range.
MeshFindings judge_mesh(const geometry::Mesh& mesh, bool as_solid);

}  // namespace fettle::core::solids
