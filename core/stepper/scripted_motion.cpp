// SPDX-License-Identifier: MIT
#include "core/stepper/scripted_motion.hpp"

#include "core/stepper/prescribed_path.hpp"
#include "core/stepper/simulate.hpp"
#include "core/stepper/step.hpp"

namespace fettle::core::stepper {

bool is_scripted(const model::Body& body) {
    for (int k = 0; k < 6; ++k) {
        if (model::is_free(body, k)) return false;
    }
    return true;
}

std::vector<std::string> held_bodies(const model::Model& model) {
    std::vector<std::string> names;
    for (const model::Body& body : model.bodies) {
        if (!is_scripted(body)) names.push_back(body.name);
    }
    return names;
}

namespace {

using kinematics::ChartPoint;

std::vector<ChartPoint> points_at(const model::Model& model, const std::vector<kinematics::Pose>& poses,
                                  const std::vector<Vector6>& targets) {
    std::vector<ChartPoint> points;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        points.push_back({poses[i].position, Vector3::Zero()});
        for (int k = 0; k < 6; ++k) {
            if (model::is_free(model.bodies[i], k)) continue;
            (k < 3 ? points.back().position[k] : points.back().rotation_vector[k - 3]) = targets[i][k];
        }
    }
    return points;
}

TrajectoryStep scripted_step(const model::Model& model, const std::vector<kinematics::Pose>& poses, double time) {
    TrajectoryStep step;
    step.nodes.emplace_back();
    for (const kinematics::Pose& pose : poses) step.nodes.back().push_back({pose.position, Vector3::Zero()});
    step.fractions.push_back(0);
    for (const PrescribedNode& node : prescribed_path(model, poses, time)) {
        step.nodes.push_back(points_at(model, poses, node.targets));
        step.fractions.push_back(node.fraction);
    }
    if (step.nodes.size() == 2) step.fractions.clear();
    return step;
}

}  // namespace

Trajectory follow_scripts(const model::Model& model, int steps) {
    SimulationOptions options;
    options.steps = steps;
    const int count = step_count(model, options);
    Trajectory out;
    out.timestep = model.timestep;
    for (const model::Body& body : model.bodies) out.body_names.push_back(body.name);
    out.poses.push_back(start_state(model).history.poses);
    for (int t = 0; t < count; ++t) {
        const std::vector<kinematics::Pose> poses = out.poses.back();
        out.steps.push_back(scripted_step(model, poses, t * model.timestep));
        out.poses.emplace_back();
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const ChartPoint& end = out.steps.back().nodes.back()[i];
            const Matrix3 turned = kinematics::rotation(end.rotation_vector) * poses[i].rotation;
            out.poses.back().push_back({kinematics::orthonormalised(turned), end.position});
        }
    }
    return out;
}

}  // namespace fettle::core::stepper
