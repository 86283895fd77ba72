// SPDX-License-Identifier: MIT
/// What the report's picture is made of: meshes, each once, and where the bodies are at times. Lengths in mm, single precision: for the
/// eye; certified values are given as numbers, from doubles.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::design::report {

/// At most so many poses of bodies are put into a report, by leaving out steps evenly: 16 MB.
inline constexpr std::size_t most_poses = 400'000;

/// Appends the seven numbers of a pose: x y z [mm] and the quaternion x y z w, on the side of that of the seven before.
void append_pose(std::vector<float>& numbers, const core::kinematics::Pose& pose);

/// Adds to `data`:
///   meshes  list of {vertices f32 [mm], triangles u32, edges u32: those of no triangle}; bodies of one shape share one
///   views   list of {name, every: each so manieth step is there, times f64 [s], bodies: list of {name, type, colour, mesh: index, poses
///   f32:
///           x y z [mm] and the quaternion x y z w, at each time; one pose of a body that does not move}}
/// The poses are those at all nodes of the path. Consecutive quaternions turn the shorter way round.
/// Contract: finite numbers.
void add_view(nlohmann::ordered_json& data, const std::string& name, const core::model::Model& model,
              const core::stepper::Trajectory& trajectory);

}  // namespace fettle::design::report
