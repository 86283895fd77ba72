// SPDX-License-Identifier: MIT
/// Union, difference and intersection of solids. Which faces cut which is found with exact arithmetic on the present values (CGAL's
/// corefinement); each new vertex is then the intersection of an edge with a face, or of three faces, of the operands, as a recorded
/// formula: the derivative is exact. The combinatorics are a decision of the drawing (drawing.hpp): kept while they hold, and a change is
/// told.
///
/// Needs CGAL when fettle is configured (FETTLE_CGAL); without it solids whose boxes are apart can be united, and all else is an error that
/// says so. CGAL's corefinement is under the GPL.
///
/// For `Lean::cover` draw what is cut away with Lean::within: then the difference covers the true one.
#pragma once

#include <vector>

#include "fettle/core/parts/solid.hpp"

namespace fettle::core::parts {

/// Whether this build has them.
bool has_solid_booleans();

/// Errors: unsupported (no CGAL); an empty result; faces that lie on each other or touch in a way that leaves no closed surface: move one
/// of the two by a little, or stack layers (extrude.hpp), which may share faces.
Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> united(Drawing& drawing, const std::vector<Solid>& solids);
Result<Solid> difference(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> intersection(Drawing& drawing, const Solid& a, const Solid& b);

}  // namespace fettle::core::parts
