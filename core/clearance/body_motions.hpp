// SPDX-License-Identifier: MIT
/// What the pairs of a body share in a certification: its pieces, its solid, and its path segment by segment.
#pragma once

#include <memory>
#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "core/clearance/pair_details.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::clearance {

using PathPlace = certificate::Place;

/// All segments of the path in order; without motion, or without steps, the start pose alone.
std::vector<PathPlace> path_places(const stepper::Trajectory& trajectory, bool motion);
/// Those of steps [first, last).
std::vector<PathPlace> path_places(const stepper::Trajectory& trajectory, int first, int last);

/// The segment of a body at a place.
kinematics::PathSegment segment_at(const stepper::Trajectory& trajectory, const PathPlace& place, int body);

/// [body] Are its numbers finite, and small enough that no product of a few of them overflows? As the checker's limit
/// (certificate/interval_motion.hpp).
std::vector<char> have_usable_numbers(const model::Model& model, const stepper::Trajectory& trajectory,
                                      const std::vector<PathPlace>& places);

/// Those that some pair is of, each once, increasing. Contract: pairs of two of `count` bodies.
std::vector<int> bodies_of(const std::vector<PairRequest>& pairs, int count);

/// Bodies are taken so many at a time, all at one place after another: as their poses lie in memory.
inline constexpr int bodies_at_once = 32;

/// A body's pieces and solid, those of its first copy if it is one of several parts of the same mesh; null: the body was not asked for.
struct BodyShape {
    std::shared_ptr<const PieceTree> tree;
    std::shared_ptr<const certificate::SolidMesh> solid;
};
/// @param bodies  those that are asked for, each once.
std::vector<BodyShape> body_shapes(const model::Model& model, const std::vector<int>& bodies);

}  // namespace fettle::core::clearance
