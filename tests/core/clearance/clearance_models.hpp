// SPDX-License-Identifier: MIT
/// Models of some solids, and motions of one step: for tests of certified clearances.
#pragma once

#include <vector>

#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::tests::clearance {

inline core::model::Model model_of(const std::vector<Solid>& solids, const std::vector<Vector3>& positions) {
    core::model::Model model;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        core::model::Body body;
        body.name = "body " + std::to_string(i);
        body.mesh = solids[i].mesh;
        body.hierarchy = solids[i].hierarchy;
        body.pose_start.position = positions[i];
        model.bodies.push_back(body);
    }
    model.dhat = 1e-4;
    return model;
}

inline core::clearance::ClearanceOptions options_with(double tolerance) {
    core::clearance::ClearanceOptions options;
    options.tolerance = tolerance;
    return options;
}

// Body 0 at rest, body 1 visiting the nodes within one step.
inline core::stepper::Trajectory one_step(const core::model::Model& model, const std::vector<core::kinematics::ChartPoint>& nodes) {
    core::stepper::Trajectory trajectory = core::clearance::as_assembled(model);
    trajectory.timestep = 0.5;
    trajectory.time_start = 2;
    core::stepper::TrajectoryStep step;
    for (const auto& node : nodes) step.nodes.push_back({{model.bodies[0].pose_start.position, Vector3::Zero()}, node});
    trajectory.steps.push_back(step);
    trajectory.poses.push_back(trajectory.poses[0]);
    trajectory.poses[1][1] = {core::kinematics::rotation(nodes.back().rotation_vector), nodes.back().position};
    return trajectory;
}

inline core::clearance::ClearanceOptions over_motion(double tolerance = 1e-6) {
    core::clearance::ClearanceOptions options = options_with(tolerance);
    options.motion = true;
    return options;
}

/// Clearances of bodies 0 and 1, with a certificate or, empty, without.
inline core::clearance::ProvenClearances certified(const core::model::Model& model, const core::stepper::Trajectory& trajectory,
                                                   double minimum, const core::clearance::ClearanceOptions& options, bool with_proof) {
    const std::vector<core::clearance::PairRequest> pairs{{0, 1, minimum}};
    if (with_proof) return certify_with_proof(model, trajectory, pairs, options);
    return {certify(model, trajectory, pairs, options), {}};
}

}  // namespace fettle::tests::clearance
