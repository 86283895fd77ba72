// SPDX-License-Identifier: MIT
/// How the nodes inside a step's path move with the step's ends, as far as that is known. The first and the last node are the ends. Two
/// kinds of the others are a function of the ends, or as good as one:
/// - where a prescribed motion changes inside the step (its table, its stop: core/stepper/prescribed_path.hpp) the path has a node, and a
///   body all of whose coordinates are prescribed by curves is there where they say. With the rate it moves by the share of the step's
///   running time that has passed, with the start as it is, the offset by the table being along the world's axes;
/// - where both bodies of a pair are at one share of the way straight from one known node to the next, the node is not there as far as
///   the two are concerned: the distance's least value along a straight path knows nothing of where it is cut.
/// Every other node is an accepted point of a line search, or where a minimisation of its own put a body that moves freely. Its place is
/// a function of much, but of no more than values that the solver happened to take: it has no derivative.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::clearance {

/// The derivative of a node's chart coordinates (position, rotation vector), entry by entry: d(coordinate) = (1 - share) d(start's) + share
/// d(end's), the start's rotation vector being 0.
using NodeShare = Vector6;

/// How bodies a and b move at node k of step t; nothing if it is not known. Contract: 0 <= k < nodes of the step.
std::optional<std::array<NodeShare, 2>> node_shares(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                                                    int k, int a, int b);

/// Why the distance at a witness has no derivative in the configurations, with the step; empty: it has one.
std::string no_derivative_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int a, int b,
                             const core::clearance::Witness& witness);

}  // namespace fettle::adjoint::clearance
