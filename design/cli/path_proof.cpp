// SPDX-License-Identifier: MIT
#include "fettle/design/cli/path_proof.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/limits.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using core::clearance::PairClearance;
using core::clearance::PairRequest;

constexpr int most_rounds = 4;    // of pairs that are left open
constexpr int most_reaches = 60;  // looked at one after another, each some times the last
constexpr double share = 1e-2;    // of the least distance: how well it is told

bool any_may_collide(const core::model::Model& model) {
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (core::model::may_collide(model, a, b)) return true;
        }
    }
    return false;
}

std::string open_pair(const core::model::Model& model, const PairClearance& pair) {
    const auto name = [&](int body) { return "\"" + model.bodies[static_cast<size_t>(body)].name + "\""; };
    const std::string who = name(pair.a) + " and " + name(pair.b);
    if (pair.intersecting) return who + " pass through each other";
    return formatted("%s are proven only to stay %.3g m apart or more (%.3g m was found), which must be more than dmin, %.3g m",
                     who.c_str(), pair.lower, pair.upper, model.dmin);
}

// What a round of searches comes to.
struct Judgement {
    double lower = infinity, upper = infinity;  // of the least distance of all
    double settled = infinity;                  // lower bound of what is proven to stay farther apart than dmin
    std::vector<PairRequest> open;              // not proven to stay farther apart than dmin; each pair once
    std::string reason;                         // of the first of them
    bool refuted = false;                       // one of them comes as near as dmin, or crosses
    bool whole = true;                          // no search was cut short
};

Judgement judge(const core::model::Model& model, const std::vector<PairClearance>& pairs, double lower_of_others) {
    Judgement judged;
    judged.lower = judged.settled = lower_of_others;
    for (const PairClearance& pair : pairs) {
        judged.whole = judged.whole && pair.complete;
        judged.lower = std::min(judged.lower, pair.lower);
        judged.upper = std::min(judged.upper, pair.upper);
        if (pair.lower > model.dmin) {
            judged.settled = std::min(judged.settled, pair.lower);
            continue;
        }
        if (judged.reason.empty()) judged.reason = open_pair(model, pair);
        judged.refuted = judged.refuted || pair.intersecting || !(pair.upper > model.dmin);
        const auto same = [&](const PairRequest& other) { return other.a == pair.a && other.b == pair.b; };
        if (judged.open.empty() || !same(judged.open.back())) judged.open.push_back({pair.a, pair.b, 0});
    }
    return judged;
}

PathProof stopped() { return {ProofState::stopped, std::nullopt, "the proof of the path was stopped on request"}; }

// Pairs that are left open are searched again, a hundred times closer each time.
PathProof look_closer(const core::model::Model& model, const core::stepper::Simulation& simulation,
                      core::clearance::ClearanceOptions options, Judgement judged) {
    for (int round = 1; !judged.refuted && round < most_rounds; ++round) {
        options.tolerance *= 1e-2;
        judged = judge(model, core::clearance::certify_clearance(model, simulation.trajectory, judged.open, options), judged.settled);
        if (!judged.whole && options.should_stop()) return stopped();
        if (judged.open.empty()) return {ProofState::proven, judged.settled, {}};
    }
    return {ProofState::not_certified, judged.lower, judged.reason};
}

}  // namespace

const char* to_string(ProofState state) {
    switch (state) {
        case ProofState::proven:
            return "proven";
        case ProofState::nothing:
            return "no pair may collide";
        case ProofState::not_certified:
        case ProofState::stopped:
            break;
    }
    return "not certified";
}

PathProof prove_path(const core::model::Model& model, const core::stepper::Simulation& simulation,
                     const std::function<bool()>& should_stop) {
    if (!any_may_collide(model)) return {};
    double reach = model.dmin + model.dhat;
    for (const auto& step : simulation.report.steps) reach = std::min(reach, step.minimum_distance);
    reach *= 1 + share;  // so that what was seen is found within it
    if (!(reach > model.dmin)) reach = model.dmin + model.dhat;
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.sample_nodes = false;
    options.measure_overlap = false;
    options.should_stop = should_stop;
    double known = infinity;  // a distance that was found: the least is no more
    for (int round = 1;; ++round) {
        options.tolerance = share * reach;
        const core::clearance::NearClearances near = core::clearance::certify_near(model, simulation.trajectory, reach, options);
        const Judgement judged = judge(model, near.windows, near.everything ? infinity : reach);
        if (!judged.whole && should_stop()) return stopped();
        if (!judged.open.empty()) return look_closer(model, simulation, options, judged);
        known = std::min(known, judged.upper);
        // Found within the reach, and the reach is no coarse measure of it.
        const bool told = known <= reach && 2 * known >= reach;
        if (told || round == most_reaches) return {ProofState::proven, judged.lower, {}};
        reach = known <= reach ? known : std::min(known, 8 * reach);
    }
}

}  // namespace fettle::design::cli
