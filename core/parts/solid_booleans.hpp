// SPDX-License-Identifier: MIT
/// Union, difference and intersection of solids. Which faces cut which is found with exact arithmetic on the present values (CGAL's
/// corefinement); each new vertex is then where an edge of one operand goes through a face of the other, as a recorded formula, and so its
/// derivative is exact: an edge that an earlier cut made stays the intersection of its two faces. The combinatorics are a decision of the
/// drawing (drawing.hpp): kept while the same sides go through the same triangles and none is turned over, and a change is told.
///
/// Needs CGAL when fettle is configured (FETTLE_CGAL); without it solids that do not meet can be combined, and all else is an error that
/// says so. CGAL's corefinement is under the GPL.
///
/// Deviations: a union has the larger ones of its operands. For `Lean::cover` draw what is cut away with Lean::within: then the difference
/// covers the true one, and its deviation outwards is 0, proven. What is not 0 is drawn out where faces meet at an angle phi, by
/// 1 / sin(phi / 2): to first order, for faces are curved, so that it is not told as proven.
#pragma once

#include <vector>

#include "core/parts/solid.hpp"

namespace fettle::core::parts {

/// Whether this build can cut solids.
bool has_solid_booleans();

/// Faces that are flush to rounding are made flush (aligned_solids.hpp), and flat faces stay one face (merged_faces.hpp): cuts of cuts of
/// solids on a grid stay on it. Errors: unsupported (no CGAL; a surface that touches itself along an edge); an empty result; corners that
/// are not finite, and such as rounding does not tell from each other.
Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> difference(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> intersection(Drawing& drawing, const Solid& a, const Solid& b);
/// The same of many, in an order in which what stands in between is a solid, too, if one is found.
Result<Solid> united(Drawing& drawing, const std::vector<Solid>& solids);
Result<Solid> difference(Drawing& drawing, const Solid& a, const std::vector<Solid>& cut);
Result<Solid> intersection(Drawing& drawing, const std::vector<Solid>& solids);

}  // namespace fettle::core::parts
