// SPDX-License-Identifier: MIT
/// Union, difference and intersection of solids. This build has none (has_solid_booleans()): solids whose boxes are apart can be united,
/// and all else is an error that says so. What they are to be: which faces cut which found with exact arithmetic (CGAL's corefinement),
/// each new vertex recorded as the intersection of an edge with a face, or of three faces, of the operands, so that the derivative is
/// exact.
///
/// For `Lean::cover` draw what is cut away with Lean::within: then the difference covers the true one.
#pragma once

#include <vector>

#include "fettle/core/parts/solid.hpp"

namespace fettle::core::parts {

/// Whether this build has them.
bool has_solid_booleans();

/// Errors: unsupported.
Result<Solid> united(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> united(Drawing& drawing, const std::vector<Solid>& solids);
Result<Solid> difference(Drawing& drawing, const Solid& a, const Solid& b);
Result<Solid> intersection(Drawing& drawing, const Solid& a, const Solid& b);

}  // namespace fettle::core::parts
