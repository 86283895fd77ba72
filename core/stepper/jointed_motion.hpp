// SPDX-License-Identifier: MIT
/// Motion without dynamics of bodies that joints hold and motors drive: at every node the bodies stand where joints, motors and scripts
/// have them (constraint/assembly.hpp), so that closed loops are followed through their cycle. Without joints: scripted_motion.hpp.
///
/// Only what is determined can be followed: of bodies that rows connect, as many rows as free coordinates. Where no motor and no script
/// drives any of them they are held at the start, and named; where some freedom is left, or a motor turns by torque alone, dynamics would
/// have to decide, and that is an error that names them.
///
/// Between nodes the path is straight in each body's chart, and joints part by at most `joint_gap` (joint_outputs.hpp). Steps are halved,
/// all of them, until that is at most what is asked for and no body turns by more than 0.5 rad, or a step is 1/256 of the model's.
///
///     const auto motion = core::stepper::follow_joints(model, -1, core::stepper::default_joint_gap(model));
///     for (const auto& error : motion.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!motion) return 3;
///     for (const auto& name : motion->held) std::printf("%s is driven by nothing\n", name.c_str());
///     std::printf("%zu steps; between them joints part by at most %g m\n", motion->trajectory.steps.size(), motion->joint_gap);
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

struct JointedMotion {
    Trajectory trajectory;
    int parts = 1;                  ///< of each step of the model
    double joint_gap = 0;           ///< between nodes, over the whole motion [m]
    std::vector<std::string> held;  ///< bodies that stay where they start although they could move
};

/// Bodies that could move, but that no motor and no script drives: follow_joints holds them.
std::vector<std::string> undriven_bodies(const model::Model& model);

/// What joints may part by between nodes unless someone asks for less or more: a hundred-thousandth of the smallest mechanism, which is
/// the diagonal of the box round the bodies that joints connect and nothing else moves, where they start [m].
double default_joint_gap(const model::Model& model);

/// @param steps        of the model; negative: its end_time, or 1000 steps if it has none.
/// @param allowed_gap  [m] > 0
/// Errors: what is not determined; a time at which the joints cannot be met (a dead centre that is not passed, a motor out of reach).
base::Result<JointedMotion> follow_joints(const model::Model& model, int steps, double allowed_gap);

}  // namespace fettle::core::stepper
