// SPDX-License-Identifier: MIT
/// What two solids have in common, by an exact cut (solid_cut.hpp): its volume, and which facets of which of the two bound it.
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/parts/solid_cut.hpp"

namespace fettle::core::parts {

struct CommonPart {
    std::vector<Vector3> points;         ///< [m]
    std::vector<CutTriangle> triangles;  ///< counter-clockwise from outside of it; none: the two have no volume in common
    double moved = 0;                    ///< by how much b was moved before it was cut [m]

    Vector3 corner(const CutTriangle& t, std::size_t k) const { return points[t.corners[k]]; }
    /// |t| times its unit normal, outward.
    Vector3 area_of(const CutTriangle& t) const;
    double area() const;
    double volume() const;
};

/// Solids that touch themselves along an edge where they are cut have no mesh: then b is moved by a billionth of the two solids' size, in
/// some direction, which leaves its volume as it is up to that times its area.
/// Errors: a mesh that is no perfect solid (solids/mesh_validity.hpp), a build without CGAL, and what cannot be cut, moved or not.
Result<CommonPart> common_part(const geometry::Mesh& a, const geometry::Mesh& b);

/// Those parts of it that hang together, each with its cavities, in the order of their first triangles; of each the points that it uses.
std::vector<CommonPart> pieces_of(const CommonPart& whole);

}  // namespace fettle::core::parts
