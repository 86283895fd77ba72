// SPDX-License-Identifier: MIT
#include "fettle/design/cli/path_proof.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/clearance/clearance.hpp"
#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using core::clearance::PairClearance;
using core::clearance::PairRequest;

constexpr int most_rounds = 4;

std::vector<PairRequest> pairs_that_may_collide(const core::model::Model& model) {
    std::vector<PairRequest> pairs;
    const int count = static_cast<int>(model.bodies.size());
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (core::model::may_collide(model, a, b)) pairs.push_back({a, b, 0});
        }
    }
    return pairs;
}

std::string open_pair(const core::model::Model& model, const PairClearance& pair) {
    const auto name = [&](int body) { return "\"" + model.bodies[static_cast<size_t>(body)].name + "\""; };
    const std::string who = name(pair.a) + " and " + name(pair.b);
    if (pair.intersecting) return who + " pass through each other";
    return formatted("%s are proven only to stay %.3g m apart or more (%.3g m was found), which must be more than dmin, %.3g m",
                     who.c_str(), pair.lower, pair.upper, model.dmin);
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
    PathProof proof;
    double seen = model.dhat;
    for (const auto& step : simulation.report.steps) seen = std::min(seen, step.minimum_distance);
    std::vector<PairRequest> pairs = pairs_that_may_collide(model);
    if (pairs.empty()) return proof;
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-2 * seen;
    options.sample_nodes = false;
    options.measure_overlap = false;
    options.should_stop = should_stop;
    proof.lower = std::numeric_limits<double>::infinity();
    for (int round = 1;; ++round, options.tolerance *= 1e-2) {
        std::vector<PairRequest> open;
        std::string reason;
        bool refuted = false, whole = true;
        double least = *proof.lower;  // of the open ones too
        for (const PairClearance& pair : core::clearance::certify_clearance(model, simulation.trajectory, pairs, options)) {
            whole = whole && pair.complete;
            least = std::min(least, pair.lower);
            if (pair.lower > model.dmin) {
                proof.lower = std::min(*proof.lower, pair.lower);
                continue;
            }
            if (reason.empty()) reason = open_pair(model, pair);
            refuted = refuted || pair.intersecting || !(pair.upper > model.dmin);
            open.push_back({pair.a, pair.b, 0});
        }
        if (!whole && should_stop()) return {ProofState::stopped, std::nullopt, "the proof of the path was stopped on request"};
        if (open.empty()) return {ProofState::proven, proof.lower, {}};
        if (refuted || round == most_rounds) return {ProofState::not_certified, least, reason};
        pairs = open;
    }
}

}  // namespace fettle::design::cli
