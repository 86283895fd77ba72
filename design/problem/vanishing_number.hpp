// SPDX-License-Identifier: MIT
/// Is a recorded number (core/expression/tape.hpp) the same, whatever its inputs are? It is written as a sum c_0 + sum c_i x_i of atoms:
/// inputs and the results of operations that are not linear. Two atoms are one if they are the same operation on the same sums, so that L
/// cos(a) / 2 - L / 2 cos(a) is seen to vanish wherever it comes from.
#pragma once

#include <span>

#include "core/expression/tape.hpp"
#include "core/geometry/range.hpp"

namespace fettle::design::problem {

/// Is |number| at most `allowed` for all inputs within these ranges? False where that is not seen.
bool vanishes(const core::expression::Number& number, std::span<const core::geometry::Range> inputs, double allowed);

}  // namespace fettle::design::problem
