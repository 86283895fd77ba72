// SPDX-License-Identifier: MIT
/// How finely a program wrote the coordinates of a mesh: estimated from the coordinates themselves, so that steps of differences can be
/// chosen.
#pragma once

#include "core/base/types.hpp"

namespace fettle::design::shapes {

/// Half a unit in the last digit of the largest coordinate [m].
/// The digits are the least number that all coordinates have in common, at least 6 (what printing a number without more ado gives); of
/// coordinates that all are floats at most 7: beyond that it is the float's rounding, or the double's.
/// @param vertices  [m].  @param unit  of the numbers as written [m].
double coordinate_rounding(const Matrix3X& vertices, double unit);

}  // namespace fettle::design::shapes
