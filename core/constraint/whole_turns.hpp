// SPDX-License-Identifier: MIT
/// Whole turns of angles: how many of them bring geared joints back to where they were, and which of them is meant at a start.
/// docs/method/joints.md#measures.
#pragma once

#include <optional>
#include <vector>

#include "core/constraint/row.hpp"

namespace fettle::core::constraint {

/// The least number of whole turns of a joint after which all that turn at these rates of it have made whole turns too; none up to 1000.
std::optional<int> turns_to_return(const std::vector<double>& rates);

/// Angles of the same poses that meet the constraints, each by the turn that is nearest to `wanted`. A constraint on one angle (a motor, a
/// screw, a rack) says how often that has turned, so it stays, and with it all that is geared to it; angles that gears alone join are
/// turned together.
/// @param wanted, angles  per measure, as of angles_at
std::vector<double> nearest_turns(const measure::MeasureSet& set, const std::vector<Row>& rows, const std::vector<double>& wanted,
                                  std::vector<double> angles);

}  // namespace fettle::core::constraint
