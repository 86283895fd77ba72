// SPDX-License-Identifier: MIT
/// Limits of joints and springs. They are closed: what stands at its limit, to within the errors of rounding and assembling, is within.
/// docs/method/joints.md#springs-dampers-stops-friction.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::core::model {

/// The share of dhat by which a coordinate may stand beyond its limit and still stand at it.
inline constexpr double at_limit = 1e-2;

/// Is it that of a ball joint's swing, a stop of the cosine of the angle between the two axes?
bool is_swing(const Mechanism& mechanism, const MeasureTerm& stop);

/// How far a value is within a stop's limit, in lengths; less than 0: beyond it [m].
double room_within(const MeasureTerm& stop, double value);

/// Least and greatest value that the stops of a measure leave it; none: it has no stops.
std::optional<std::array<double, 2>> limits_of(const Mechanism& mechanism, int measure);

/// What stands beyond its limits, a sentence each: "`hinge` is at -10 deg, beyond its limits, 0 to 90 deg".
/// @param angles  of the measures, with their turns
std::vector<std::string> beyond_limits(const Model& model, const std::vector<kinematics::Pose>& poses, const std::vector<double>& angles);

/// "0 to 90 deg", "-3 to 12.5 mm".
std::string range_text(const Model& model, int measure, double low, double high);

}  // namespace fettle::core::model
