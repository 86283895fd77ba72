// SPDX-License-Identifier: MIT
#include "core/stepper/kept_contacts.hpp"

#include <algorithm>
#include <utility>

namespace fettle::core::stepper {
namespace {

using kinematics::Pose;

bool is_in_place(const contact::ContactPair& pair, const contact::BodyPairContacts& list, const model::Model& model,
                 const std::vector<Pose>& poses) {
    const int on_first = geometry::first_count(pair.type);
    for (int i = 0; i < 4; ++i) {
        const int number = i < on_first ? list.first : list.second, vertex = pair.vertex[i];
        const model::Body& body = model.bodies[number];
        const Eigen::Index place = vertex >= 0 ? vertex : -1 - vertex;
        if (vertex < 0 && !body.round) return false;
        if (place >= (vertex >= 0 ? body.mesh.vertices.cols() : body.round->centres.cols())) return false;
        if (pair.x[i] != world_position(poses[number], contact::undeformed_vertex(body, vertex))) return false;
    }
    return true;
}

}  // namespace

KeptContacts kept_contacts(const model::Model& model, std::vector<Pose> poses, contact::ContactSet contacts) {
    return {std::move(poses), std::move(contacts), model.dmin, model.dhat, model.round_reach};
}

bool are_of(const KeptContacts& kept, const model::Model& model, const std::vector<Pose>& poses) {
    const auto same = [](const Pose& a, const Pose& b) { return a.position == b.position && a.rotation == b.rotation; };
    if (poses.size() != model.bodies.size() || !std::equal(kept.poses.begin(), kept.poses.end(), poses.begin(), poses.end(), same))
        return false;
    if (kept.dmin != model.dmin || kept.dhat != model.dhat || kept.round_reach != model.round_reach) return false;
    return std::all_of(kept.contacts.pairs.begin(), kept.contacts.pairs.end(), [&](const contact::BodyPairContacts& list) {
        return std::all_of(list.contacts.begin(), list.contacts.end(),
                           [&](const contact::ContactPair& pair) { return is_in_place(pair, list, model, poses); });
    });
}

}  // namespace fettle::core::stepper
