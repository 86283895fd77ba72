// SPDX-License-Identifier: MIT
/// The pairs of bodies that a report shows, and their certified distance along the motion. Lengths in mm.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/clearance/clearance.hpp"

namespace fettle::design::report {

/// At most so many rows are shown, and so many of them with their curve over time.
inline constexpr std::size_t most_pairs = 200, most_margins = 8;

/// Steps [first, last) of the motion that bounds are of; none: as assembled.
struct StepRange {
    int first = 0, last = 0;
};

/// A row {a, b, body_a, body_b: indices, -1: none, motion, steps: [first, last), minimum: null if none is required, lower, upper: null if
/// not measured, status, finding, time [s], point_a, point_b: null if not measured, depth, volume, touching, poses, note} of each pair of
/// an answer (docs/interface.md), up to most_pairs. For a clash `time` is when it begins, depth {lower, upper [mm], time [s], point: the
/// middle of what both share, null if not known} and volume {lower, upper [mm^3]} of their common part at their deepest instant; null if
/// not measured. For a touching pair `touching` is {area [mm^2], 0: in edges and points, at_least: is that all, or were there too many
/// faces?, allowed}. For a pair over the ranges of joints `poses` are those of all bodies where it is worst (seven numbers of each, as
/// moving_parts.hpp has them), else null, and the note says where that is.
/// @param pairs   `pairs` of `fettle clearance`, or of `clearance` of `fettle optimise`.
/// @param steps  per pair.
nlohmann::ordered_json told_pairs(const nlohmann::ordered_json& pairs, const core::model::Model& model,
                                  const std::vector<StepRange>& steps);

/// Such a row of one pair as it was certified over the trajectory, of whose steps it is.
nlohmann::ordered_json pair_row(const core::clearance::PairClearance& pair, const core::model::Model& model,
                                const core::stepper::Trajectory& trajectory);

/// For parts that share material, or touch, a distance of rounding's size says nothing: their `lower` and `upper` become null.
/// @param rows  after margin_curves, which needs them.
void leave_out_distances(nlohmann::ordered_json& rows);

/// Such rows of a simulation, which has none of its own: of the pairs that come nearest to each other, the nearest first; empty if none may
/// collide. Their bounds are certified.
/// @param least  the least distance of all [m].
nlohmann::ordered_json nearest_pairs(const core::model::Model& model, const core::stepper::Trajectory& trajectory, double least,
                                     const std::function<bool()>& should_stop);

/// {time f64 [s]: where each stretch of the path begins, and where the last one ends; pairs: list of {pair: index of a row, least: proven
/// over all stretches, lower f32, upper f32: certified for each stretch}} of the first rows over the motion; null if there are none. Lower
/// bounds are no less than what rows of the same bodies prove of the same steps. In single precision they are rounded down, upper ones up.
nlohmann::ordered_json margin_curves(const nlohmann::ordered_json& rows, const core::model::Model& model,
                                     const core::stepper::Trajectory& trajectory, const std::function<bool()>& should_stop);

}  // namespace fettle::design::report
