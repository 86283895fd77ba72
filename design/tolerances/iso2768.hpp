// SPDX-License-Identifier: MIT
/// General tolerances: what holds for dimensions of a drawing that carry none of their own, by ISO 2768-1. All are symmetric.
/// Class: "f" fine, "m" medium, "c" coarse, "v" very coarse.
/// Errors of all three functions: an unknown class, a size for which the standard gives no value (out_of_range); infinity or NaN
/// (not_finite).
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/tolerances/deviation_limits.hpp"

namespace fettle::design::tolerances {

/// Linear sizes other than broken edges (table 1): outside and inside sizes, steps, diameters, distances, radii that round no edge.
/// @param nominal  [m], 0.0005 to 4; f up to 2, v over 0.003. Below 0.5 mm the standard wants the tolerance beside the dimension.
/// @return         [m]
Result<DeviationLimits> iso2768_linear(std::string_view general_class, double nominal, const std::string& where);

/// Broken edges: outer radii and heights of chamfers (table 2).
/// @param nominal  Radius or height [m], at least 0.0005.
/// @return         [m]
Result<DeviationLimits> iso2768_edge(std::string_view general_class, double nominal, const std::string& where);

/// Angles (table 3).
/// @param shorter_leg  Length of the shorter leg of the angle [m], over 0.
/// @return             [rad]
Result<DeviationLimits> iso2768_angle(std::string_view general_class, double shorter_leg, const std::string& where);

}  // namespace fettle::design::tolerances
