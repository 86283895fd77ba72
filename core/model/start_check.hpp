// SPDX-License-Identifier: MIT
/// Does a simulation start from a legal configuration? Intersections are decided exactly, on the world positions as rounded.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"

namespace fettle::core::model {

struct StartReport {
    base::Errors errors;                ///< why a simulation cannot start here
    std::vector<std::string> warnings;  ///< what it starts with all the same
    /// Whom the scene's `ignore` would have to name, if they are not meant to meet: of the errors, and of the warnings those that joints
    /// join. In order.
    std::vector<std::pair<int, int>> overlapping;
};

/// For every pair of bodies that may collide: no two elements intersect or touch, none come as close as dmin (judged in floating point),
/// and neither body lies wholly inside the other's material.
///   errors: one bodies_intersect error per pair at fault, which names the bodies, two elements (the first intersecting ones found, else
///           the closest) and a place in world coordinates, in the model's length_unit. Order: by pair of bodies; the same for any machine.
///   warnings: pairs that contact never acts on and that intersect or lie one in the other: because neither is dynamic, or because a joint
///           joins them, unless it explains what they share (joint_fit.hpp). Bodies of one group, and pairs that the scene ignores, are
///           meant to. And pairs of which one may lie inside the other, which cannot be verified where the outer mesh is not closed though
///           meant to be (geometry::is_nearly_closed). At most 20, then a count.
/// Contract: hierarchies built.
StartReport report_start(const Model& model);

/// The errors alone.
base::Errors check_start(const Model& model);

/// The error of one pair, whether the model lets it collide or not; nothing if there is no fault.
std::optional<base::Error> check_start_pair(const Model& model, int a, int b);

}  // namespace fettle::core::model
