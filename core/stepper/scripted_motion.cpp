// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/scripted_motion.hpp"

#include "fettle/core/stepper/simulate.hpp"
#include "fettle/core/stepper/step.hpp"

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
        const std::vector<Vector6> targets = prescribed_targets(model, poses, t * model.timestep);
        TrajectoryStep step;
        step.nodes.resize(2);
        std::vector<kinematics::Pose> next;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            kinematics::ChartPoint end{poses[i].position, Vector3::Zero()};
            for (int k = 0; k < 6; ++k) {
                if (model::is_free(model.bodies[i], k)) continue;
                (k < 3 ? end.position[k] : end.rotation_vector[k - 3]) = targets[i][k];
            }
            step.nodes[0].push_back({poses[i].position, Vector3::Zero()});
            step.nodes[1].push_back(end);
            const Matrix3 turned = kinematics::rotation(end.rotation_vector) * poses[i].rotation;
            next.push_back({kinematics::orthonormalised(turned), end.position});
        }
        out.steps.push_back(std::move(step));
        out.poses.push_back(std::move(next));
    }
    return out;
}

}  // namespace fettle::core::stepper
