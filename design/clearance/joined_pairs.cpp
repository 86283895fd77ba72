// SPDX-License-Identifier: MIT
#include "design/clearance/joined_pairs.hpp"

#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "core/model/joint_fit.hpp"

namespace fettle::design::clearance {

namespace {

using core::clearance::PairClearance;
using core::clearance::PairStatus;

// Leaves two that share material undecided: a doubt is no clash.
void doubt(const std::string& reason, JoinedPair& pair) {
    pair.finding = JoinedFinding::undecided;
    pair.clearance.status = PairStatus::undecided;
    pair.clearance.reason = reason;
    pair.clearance.intersecting = false;
    pair.clearance.solids = core::clearance::Solids::unproven;
}

void explain(const core::model::Model& model, JoinedPair& pair) {
    if (pair.joints.empty())
        return doubt("they share material, and a trajectory does not say which joint between them may explain it: give its scene or design",
                     pair);
    const auto overlap = core::model::joined_overlap(model, pair.a, pair.b);
    if (!overlap)
        return doubt(
            "they share material, and whether " + joint_text(pair) + " explains it cannot be told: " + overlap.errors().front().message,
            pair);
    pair.finding = !overlap->explained ? JoinedFinding::clash : overlap->volume > 0 ? JoinedFinding::explained : JoinedFinding::touching;
}

}  // namespace

const char* to_string(JoinedFinding finding) {
    switch (finding) {
        case JoinedFinding::clash:
            return "clash";
        case JoinedFinding::undecided:
            return "undecided";
        case JoinedFinding::explained:
            return "explained";
        case JoinedFinding::touching:
            return "touching";
        case JoinedFinding::apart:
            break;
    }
    return "apart";
}

std::vector<JoinedPair> look_at_joined(const Subject& subject, const BodyPairs& pairs, core::clearance::ClearanceOptions options) {
    options.motion = options.margin_curve = options.sample_nodes = false;
    options.witness_tolerance = 0;
    options.on_pair = nullptr;
    options.enough = 10 * options.tolerance;
    std::vector<core::clearance::PairRequest> requests;
    for (const auto& [a, b] : pairs) requests.push_back({a, b, 0});
    const core::stepper::Trajectory start = core::clearance::as_assembled(subject.model);
    std::vector<JoinedPair> out;
    for (PairClearance& found : core::clearance::certify(subject.model, start, requests, options)) {
        JoinedPair pair{found.a, found.b, core::model::joints_between(subject.model, found.a, found.b), std::move(found)};
        pair.clearance.as_assembled = true;
        if (pair.clearance.is_clash())
            explain(subject.model, pair);
        else if (pair.clearance.lower > 0 && core::certificate::are_apart(pair.clearance.solids))
            pair.finding = JoinedFinding::apart;
        else if (pair.clearance.touch)
            pair.finding = JoinedFinding::touching;
        out.push_back(std::move(pair));
    }
    return out;
}

std::string joint_text(const JoinedPair& pair) {
    if (pair.joints.empty()) return "a joint";
    return pair.joints.size() == 1 ? "joint " + pair.joints.front() : "joints " + core::base::joined(pair.joints);
}

}  // namespace fettle::design::clearance
