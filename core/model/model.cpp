// SPDX-License-Identifier: MIT
#include "fettle/core/model/model.hpp"

#include <algorithm>

namespace fettle::core::model {

kinematics::Pose scripted_pose(const Body& body, double time) {
    const scene::PoseScript& script = body.script;
    const std::size_t next =
        static_cast<std::size_t>(std::upper_bound(script.times.begin(), script.times.end(), time) - script.times.begin());
    if (next == script.times.size()) return script.poses.back();
    const double t0 = next == 0 ? 0 : script.times[next - 1];
    const kinematics::Pose& from = next == 0 ? body.pose_start : script.poses[next - 1];
    if (time <= t0) return from;
    const kinematics::Pose& to = script.poses[next];
    const double s = (time - t0) / (script.times[next] - t0);
    const Vector3 turn = kinematics::rotation_vector(to.rotation * from.rotation.transpose());
    return {kinematics::rotation(s * turn) * from.rotation, from.position + s * (to.position - from.position)};
}

bool may_collide(const Model& model, int a, int b) {
    if (a == b) return false;
    const Body& first = model.bodies[static_cast<std::size_t>(a)];
    const Body& second = model.bodies[static_cast<std::size_t>(b)];
    if (first.group >= 0 && first.group == second.group) return false;
    return first.type == scene::BodyType::dynamic_body || second.type == scene::BodyType::dynamic_body;
}

}  // namespace fettle::core::model
