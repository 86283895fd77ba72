// SPDX-License-Identifier: MIT
/// What joints and motors carried in a step, and how well they hold along its path. docs/method/joints.md.
#pragma once

#include <vector>

#include "core/energy/step_problem.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

/// What one joint, motor or gear carries (model::Mechanism::joints, by number).
struct JointForce {
    int joint = 0;
    Vector3 force = Vector3::Zero();   ///< on body b (of a joint with the world alone: on that body), world [N]
    Vector3 torque = Vector3::Zero();  ///< on it, about the joint's point in b [N m]
    /// For a motor: along its joint's coordinate, so that effort times speed is its power. For a gear or rack: what it pushes its second
    /// joint's coordinate with; it pushes the first one's with -ratio times that. [N], [N m]; 0 for others.
    double effort = 0;
    /// The joint's own forces, along its coordinate, positive where they push it up: [N] for a slide, [N m] for an angle. They act between
    /// the two bodies as well, and are not in `force` and `torque`, which are what it takes to keep the joint together.
    double spring = 0, damping = 0, friction = 0, stop = 0;
};

/// @param poses           at the step's end.
/// @param multipliers     per row, of the potential times its weight.
/// @param measure_forces  per term of the mechanism (energy::TermReport).
std::vector<JointForce> joint_forces(const energy::StepProblem& problem, const std::vector<kinematics::Pose>& poses,
                                     const VectorX& multipliers, const std::vector<double>& measure_forces);

/// Bound on how far a joint's two points part (or leave the line or plane that they are to keep to) between the nodes of a step's path: the
/// deviations B1 of both points from their chords (docs/method/collision.md), the largest over the path's segments and the joints that
/// hold a point [m].
double path_gap_bound(const model::Model& model, const std::vector<kinematics::Pose>& poses_t0, const TrajectoryStep& path);

}  // namespace fettle::core::stepper
