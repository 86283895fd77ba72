// SPDX-License-Identifier: MIT
#include "fettle/core/model/model.hpp"

#include <algorithm>

namespace fettle::core::model {

kinematics::Pose scripted_pose(const Body& body, double time) { return scene::scripted_pose(body.script, body.pose_start, time); }

linear::FreeDofs free_dofs(const Model& model) {
    linear::FreeDofs out;
    for (const Body& body : model.bodies) out.add_body([&](int k) { return is_free(body, k); });
    return out;
}

bool may_collide(const Model& model, int a, int b) {
    if (a == b) return false;
    const Body& first = model.bodies[a];
    const Body& second = model.bodies[b];
    if (first.group >= 0 && first.group == second.group) return false;
    const auto& joined = model.mechanism.not_colliding;
    if (!joined.empty() && std::binary_search(joined.begin(), joined.end(), std::pair<int, int>(std::minmax(a, b)))) return false;
    return first.type == scene::BodyType::dynamic_body || second.type == scene::BodyType::dynamic_body;
}

}  // namespace fettle::core::model
