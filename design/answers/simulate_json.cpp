// SPDX-License-Identifier: MIT
#include "design/answers/simulate_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/parallel.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/travels.hpp"

namespace fettle::design::answers {

using Json = nlohmann::ordered_json;

namespace {

// The bodies' file frames at the end: a frame's origin is at -c in the body's frame.
Json bodies_at_end(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    constexpr int bodies_at_once = 32;
    Json::array_t list(model.bodies.size());
    const std::vector<Travel> moved = travels(model, trajectory);
    core::base::parallel_for(count_of(list), bodies_at_once, [&](int k) {
        const auto i = static_cast<size_t>(k);
        const core::kinematics::Pose& pose = trajectory.poses.back()[i];
        Json& body = list[i] = Json::object();  // a list of pairs would be copied, twice
        body["name"] = model.bodies[i].name;
        body["position"] = vector_json(core::kinematics::world_position(pose, -model.bodies[i].reference_point));
        Json& rotation = body["rotation"] = Json::array();
        for (int row = 0; row < 3; ++row) rotation.push_back(vector_json(pose.rotation.row(row).transpose()));
        body["moved"] = moved[i].distance;
        body["turned"] = moved[i].turn;
    });
    return Json(std::move(list));
}

// Forces at the end, and how well the joints are met over the whole run.
Json joints_at_end(const core::model::Model& model, const core::stepper::Simulation& simulation) {
    Json list = Json::array();
    if (simulation.outputs.empty()) return list;
    for (const core::stepper::JointForce& f : simulation.outputs.back().joints) {
        const core::model::Joint& joint = model.mechanism.joints[f.joint];
        Json entry{{"name", joint.name}, {"force", vector_json(f.force)}, {"torque", vector_json(f.torque)}};
        if (joint.is_motor || couples_joints(joint.kind)) entry["effort"] = f.effort;
        if (!joint.is_motor && joint.coordinate >= 0)
            entry["own"] = Json{{"spring", f.spring}, {"damping", f.damping}, {"friction", f.friction}, {"stop", f.stop}};
        list.push_back(entry);
    }
    return list;
}

}  // namespace

Json run_json(const core::stepper::Simulation& simulation) {
    return Json{{"steps", simulation.trajectory.steps.size()},
                {"newton_iterations", simulation.report.newton_iterations},
                {"wall_seconds", simulation.report.wall_seconds}};
}

void add_end(const core::model::Model& model, const core::stepper::Simulation& simulation, Json& answer) {
    answer["bodies"] = bodies_at_end(model, simulation.trajectory);
    if (model.mechanism.joints.empty()) return;
    double gap = 0, path_gap = 0;
    for (const core::stepper::StepReport& step : simulation.report.steps) {
        gap = std::max(gap, step.joint_gap);
        path_gap = std::max(path_gap, step.path_joint_gap);
    }
    answer["joints"] = joints_at_end(model, simulation);
    answer["joint_gap"] = gap;
    answer["path_joint_gap"] = path_gap;
}

Json balance_json(const core::stepper::Balance& b) {
    return Json{{"energy_start", b.energy_start},
                {"energy_end", b.energy_end},
                {"work", b.work},
                {"dissipated", b.dissipated},
                {"energy_error", b.energy_error},
                {"energy_available", b.energy_available},
                {"energy_lost", b.energy_lost},
                {"momentum_error", b.momentum_error},
                {"angular_momentum_error", b.angular_momentum_error},
                {"angular_momentum_scale", b.angular_momentum_scale}};
}

}  // namespace fettle::design::answers
