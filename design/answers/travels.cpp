// SPDX-License-Identifier: MIT
#include "design/answers/travels.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>

#include "core/base/text.hpp"

namespace fettle::design::answers {

namespace {

Vector3 rotation_vector(const Matrix3& rotation) {
    const Eigen::AngleAxisd turn(rotation);
    return turn.angle() * turn.axis();
}

std::string travel_text(const std::string& name, const Travel& travel, double length_unit) {
    std::string how;
    if (travel.distance > 1e-6) how = core::base::length_text(travel.distance, length_unit);
    if (travel.turn > 1e-4)
        how += (how.empty() ? "" : ", ") + core::base::formatted("turned %.3g deg", travel.turn * 180 / std::numbers::pi);
    return name + " (" + how + ")";
}

}  // namespace

std::vector<Travel> travels(const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    std::vector<Travel> out(model.bodies.size());
    for (std::size_t i = 0; i < out.size() && !trajectory.poses.empty(); ++i) {
        const Vector3 start = trajectory.poses.front()[i].position;
        Vector3 turned = Vector3::Zero();
        for (std::size_t t = 1; t < trajectory.poses.size(); ++t) {
            const core::kinematics::Pose &before = trajectory.poses[t - 1][i], &pose = trajectory.poses[t][i];
            turned += rotation_vector(pose.rotation * before.rotation.transpose());
            out[i].distance = std::max(out[i].distance, (pose.position - start).norm());
            out[i].turn = std::max(out[i].turn, turned.norm());
        }
    }
    return out;
}

std::string travels_text(const core::model::Model& model, const std::vector<Travel>& travels) {
    constexpr std::size_t most = 8;
    std::vector<std::size_t> moved, still;
    for (std::size_t i = 0; i < travels.size(); ++i) (travels[i].is_motion() ? moved : still).push_back(i);
    const auto list = [&](const std::vector<std::size_t>& bodies, const auto& text) {
        std::string out;
        for (std::size_t k = 0; k < std::min(most, bodies.size()); ++k) out += (out.empty() ? "" : ", ") + text(bodies[k]);
        return out + (bodies.size() > most ? " and " + std::to_string(bodies.size() - most) + " more" : "");
    };
    if (moved.empty()) return "nothing moved";
    const auto reach = [&](std::size_t i) { return travels[i].distance + model.bodies[i].radius * travels[i].turn; };
    if (moved.size() > most)
        std::stable_sort(moved.begin(), moved.end(), [&](std::size_t a, std::size_t b) { return reach(a) > reach(b); });
    std::string text =
        "moved: " + list(moved, [&](std::size_t i) { return travel_text(model.bodies[i].name, travels[i], model.length_unit); });
    if (!still.empty()) text += "; not moved: " + list(still, [&](std::size_t i) { return model.bodies[i].name; });
    return text;
}

}  // namespace fettle::design::answers
