// SPDX-License-Identifier: MIT
#include "core/model/model.hpp"

#include <algorithm>

namespace fettle::core::model {

kinematics::Pose scripted_pose(const Body& body, double time) { return scene::scripted_pose(body.script, body.pose_start, time); }

linear::FreeDofs free_dofs(const Model& model) {
    linear::FreeDofs out;
    for (const Body& body : model.bodies) out.add_body([&](int k) { return is_free(body, k); });
    return out;
}

NoContact why_no_contact(const Model& model, int a, int b) {
    if (a == b) return NoContact::same_body;
    const Body& first = model.bodies[a];
    const Body& second = model.bodies[b];
    const auto is_among = [&](const std::vector<std::pair<int, int>>& pairs) {
        return !pairs.empty() && std::binary_search(pairs.begin(), pairs.end(), std::pair<int, int>(std::minmax(a, b)));
    };
    if (is_among(model.ignored)) return NoContact::ignored;
    if (first.group >= 0 && first.group == second.group) return NoContact::one_group;
    if (is_among(model.mechanism.not_colliding)) return NoContact::joined;
    if (first.type != scene::BodyType::dynamic_body && second.type != scene::BodyType::dynamic_body) return NoContact::none_dynamic;
    return NoContact::none;
}

}  // namespace fettle::core::model
