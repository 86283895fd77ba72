// SPDX-License-Identifier: MIT
/// Bodies on wild paths, some near each other and some far: for what decides that by boxes.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "core/clearance/clearance.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::tests::clearance {

struct TumblingBoxes {
    core::model::Model model;
    core::stepper::Trajectory trajectory;
};

/// Boxes that tumble and fly about in some steps of several segments; the first is static, two are of one group.
inline TumblingBoxes tumbling(int bodies, int steps, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&](double size) {
        return core::base::Vector3(size * normal(random), size * normal(random), size * normal(random));
    };
    TumblingBoxes scene;
    scene.model.dhat = 1e-3;
    for (int i = 0; i < bodies; ++i) {
        const core::base::Vector3 half(0.1 + 0.02 * i, 0.2, 0.05), off = vector(0.1);  // the reference point is not the middle
        scene.model.bodies.push_back(support::make_body("body " + std::to_string(i), support::box_mesh(off - half, off + half),
                                                        support::make_pose(vector(1), vector(1.2)),
                                                        i == 0 ? core::scene::BodyType::static_body : core::scene::BodyType::dynamic_body));
    }
    scene.model.bodies[1].group = scene.model.bodies[2].group = 7;
    scene.trajectory = core::clearance::as_assembled(scene.model);
    scene.trajectory.timestep = 0.1;
    for (int t = 0; t < steps; ++t) {
        core::stepper::TrajectoryStep step;
        step.nodes.resize(2 + t % 3);
        std::vector<core::kinematics::Pose> end = scene.trajectory.poses.back();
        for (int i = 0; i < bodies; ++i) {
            const core::kinematics::Pose& pose = scene.trajectory.poses.back()[i];
            const core::base::Vector3 turn = i == 0 ? core::base::Vector3::Zero() : vector(1.5),
                                      shift = i == 0 ? core::base::Vector3::Zero() : vector(0.4);
            for (std::size_t k = 0; k < step.nodes.size(); ++k) {
                const double s = static_cast<double>(k) / static_cast<double>(step.nodes.size() - 1);
                step.nodes[k].push_back({pose.position + s * shift, s * turn});
            }
            end[i] = {core::kinematics::rotation(turn) * pose.rotation, pose.position + shift};
        }
        scene.trajectory.steps.push_back(step);
        scene.trajectory.poses.push_back(end);
    }
    return scene;
}

}  // namespace fettle::tests::clearance
