// SPDX-License-Identifier: MIT
/// A model's joints as a linkage (certificate/linkage.hpp): which coordinates its bodies have, and within which ranges.
///   revolute, prismatic, screw   one coordinate; cylindrical: its slide, and its turn; fixed: none
///   ball                         three: how far b's axis swings from a's, within the joint's `swing` (without one: half a turn), in which
///                                direction, and how b is turned about its own axis. Without axes these are the z axis of a
///   planar                       three: two slides along a's x and y axes, and the turn about b's point
///   gear, rack                   couple coordinates, which then count once: the first joint's, within the limits of all of them; where
///                                the limits of its followers narrow its own, that is told
///   ranges                       the limits of the joint and of springs on it; a joint that only turns has a whole turn without (the
///                                joints of a gear as many as bring all of them back to where they were)
///   world                        static bodies; everything without a joint stays where it starts, and so does, of bodies that are
///                                joined to one another but not to the world, the first: `held` names them
/// Motors, springs and loads say where joints are, not where they can be: they have no effect here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/certificate/linkage.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

struct JointRanges {
    certificate::Linkage linkage;
    std::vector<std::string> held;  ///< bodies that could move, and stay where they start
    std::vector<bool> has_limits;   ///< [coordinate]: of its own, or of a joint that gears couple it to
    std::vector<int>
        direction_of;           ///< [coordinate]: of a swing the coordinate that is its direction, which means nothing by itself; else -1
    std::vector<int> joint_of;  ///< [body]: what its screws are of, a place in the mechanism's joints; -1: it has no screws
    /// Ranges that the limits of a joint's followers narrow, a sentence each: "the range of `drive` is 0 to 20 deg: `keep` narrows it from
    /// 0 to 60 deg"; and those of which they leave less than a hundredth, so that hardly anything is looked at.
    std::vector<std::string> narrowed, lost;
};

/// Is this the direction of a swing, which says nothing about where a body is while its swing is 0?
bool is_direction(const JointRanges& ranges, int coordinate);

/// Errors, each naming its joints: loops (with the joints that close them), a coordinate without limits (the slides of a planar joint have
/// none), a jointed body whose own coordinates are prescribed, no joint at all.
/// @param reach  how far slides and screws without limits go from their start either way [m]; gears that come back after no whole number of
///               turns then turn once. Nothing: these are errors.
base::Result<JointRanges> joint_ranges(const model::Model& model, std::optional<double> reach = std::nullopt);

}  // namespace fettle::core::clearance
