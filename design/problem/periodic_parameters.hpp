// SPDX-License-Identifier: MIT
/// Parameters that have no ends: angles whose bounds are a whole turn apart, and of which the design at one bound is the one at the other.
/// A search goes past such a bound, and on from the other one. The angle at which a crank stands is one; the angle that a motor turns it
/// through, from none to a whole turn, is not. Asked of the scene's numbers, not of what a simulation makes of them.
#pragma once

#include <vector>

#include "design/description/design.hpp"

namespace fettle::design::problem {

/// Per parameter. A number that follows from it is the same at both bounds to within 1e-9 of its size, or is one of a body's angles, and
/// the body's rotation is the same; a relation has the same value; no quantity follows from it but through the scene. Asked at three places
/// of the other parameters, the start among them. Nothing is made or simulated.
/// Contract: check_design finds nothing.
std::vector<bool> periodic_parameters(const description::Design& design);

}  // namespace fettle::design::problem
