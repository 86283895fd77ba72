// SPDX-License-Identifier: MIT
/// The slope of a table (core/scene/curve.hpp) in what it is over, for tables over a coordinate that moves with the design.
#pragma once

#include "core/scene/curve.hpp"

namespace fettle::design::quantities {

/// d(curve_value)/d(place), exact to rounding: between two neighbouring entries (thirds of the way from one to the next of a trapezoid,
/// equal parts of control points) a table is a polynomial of degree 3 at most, which its values at four places there determine. At an
/// entry the slope is that of the stretch after it; before the first and after the last entry it is 0. Contract: a table, without rate and
/// stop.
double curve_slope(const core::scene::Curve& curve, double place);

}  // namespace fettle::design::quantities
