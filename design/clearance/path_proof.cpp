// SPDX-License-Identifier: MIT
#include "design/clearance/path_proof.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/limits.hpp"
#include "core/base/rounded_lengths.hpp"
#include "core/base/text.hpp"
#include "core/clearance/clearance.hpp"
#include "design/answers/answer_json.hpp"

namespace fettle::design::clearance {

namespace {

using core::clearance::PairClearance;
using core::clearance::PairRequest;

constexpr int most_rounds = 4;    // of pairs that are left open
constexpr int most_reaches = 60;  // looked at one after another, each some times the last
constexpr double share = 1e-2;    // of the least distance: how well it is told

bool any_may_collide(const core::model::Model& model) {
    const int count = count_of(model.bodies);
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
            if (core::model::may_collide(model, a, b)) return true;
        }
    }
    return false;
}

std::string both_names(const core::model::Model& model, int a, int b) {
    return "\"" + model.bodies[a].name + "\" and \"" + model.bodies[b].name + "\"";
}

std::string open_pair(const core::model::Model& model, const PairClearance& pair) {
    const std::string who = both_names(model, pair.a, pair.b);
    if (pair.intersecting) return who + " pass through each other";
    if (pair.lower > model.dmin) return "of " + who + ": " + core::clearance::why_not_apart(pair.solids);
    const core::base::RoundedLengths lengths(answers::unit_name(model.length_unit));
    return who + " are proven only to stay " + lengths.fixed(pair.lower, core::base::Towards::down) + " " + lengths.unit() +
           " apart or more (" + lengths.fixed(pair.upper, core::base::Towards::up) + " " + lengths.unit() +
           " was found), which must be more than " +
           (model.dmin > 0 ? "`dmin`, " + core::base::length_text(model.dmin, model.length_unit) : std::string("nothing"));
}

// What a round of searches comes to.
struct Judgement {
    double lower = infinity, upper = infinity;  // of the least distance of all
    double settled = infinity;                  // lower bound of what is proven to stay farther apart than dmin
    std::vector<PairRequest> open;              // not proven to stay farther apart than dmin; each pair once
    std::vector<PairRequest> unverified;        // whose surfaces do, and one may lie in the other, whose mesh is not closed
    std::string reason;                         // of the first of them
    bool is_final = false;                      // one of them comes as near as dmin, crosses, or lies in the other: no search tells more
    bool whole = true;                          // no search was cut short
};

Judgement judge(const core::model::Model& model, const std::vector<PairClearance>& pairs, double lower_of_others) {
    Judgement judged;
    judged.lower = judged.settled = lower_of_others;
    for (const PairClearance& pair : pairs) {
        judged.whole = judged.whole && pair.complete;
        judged.lower = std::min(judged.lower, pair.lower);
        judged.upper = std::min(judged.upper, pair.upper);
        const bool is_unverified = pair.solids == core::clearance::Solids::unverified;
        if (pair.lower > model.dmin && !pair.intersecting && (is_unverified || core::certificate::are_apart(pair.solids))) {
            judged.settled = std::min(judged.settled, pair.lower);
            if (is_unverified) judged.unverified.push_back({pair.a, pair.b, 0});
            continue;
        }
        if (judged.reason.empty()) judged.reason = open_pair(model, pair);
        judged.is_final = judged.is_final || pair.intersecting || !(pair.upper > model.dmin) || pair.lower > model.dmin;
        const auto same = [&](const PairRequest& other) { return other.a == pair.a && other.b == pair.b; };
        if (judged.open.empty() || !same(judged.open.back())) judged.open.push_back({pair.a, pair.b, 0});
    }
    return judged;
}

core::clearance::ClearanceOptions proof_options(double tolerance, const std::function<bool()>& should_stop) {
    core::clearance::ClearanceOptions options;
    options.motion = true;
    options.sample_nodes = false;
    options.measure_overlap = false;
    options.tolerance = tolerance;
    options.should_stop = should_stop;
    return options;
}

// Adds the time of its life.
class Stopwatch {
public:
    explicit Stopwatch(double& sum) : sum_(sum), begin_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& sum_;
    std::chrono::steady_clock::time_point begin_;
};

}  // namespace

const char* to_string(ProofState state) {
    switch (state) {
        case ProofState::proven:
            return "proven";
        case ProofState::surfaces:
            return "surfaces proven";
        case ProofState::nothing:
            return "no pair may collide";
        case ProofState::not_certified:
        case ProofState::stopped:
            break;
    }
    return "not certified";
}

// Sorted, each pair once.
void make_unique(std::vector<PairRequest>& pairs) {
    const auto key = [](const PairRequest& pair) { return std::pair(pair.a, pair.b); };
    std::sort(pairs.begin(), pairs.end(), [&](const PairRequest& x, const PairRequest& y) { return key(x) < key(y); });
    pairs.erase(std::unique(pairs.begin(), pairs.end(), [&](const PairRequest& x, const PairRequest& y) { return key(x) == key(y); }),
                pairs.end());
}

// Steps [first, last); of no steps, the start.
struct PathProver::Stretch {
    int first = 0, last = 0;
    double reach = 0;  // up to which it was searched last
    Judgement judged;

    // Is the least distance over the path told by this, if it is `known` and not elsewhere?
    bool tells(double known) const { return judged.lower >= (1 - share) * known || (known <= reach && reach <= 2 * known); }
};

PathProver::PathProver(const core::model::Model& model, std::function<bool()> should_stop, int stretch)
    : model_(model), should_stop_(std::move(should_stop)), stretch_(stretch), any_pair_(any_may_collide(model)), known_(infinity) {}

PathProver::~PathProver() = default;

// So that what the ends of the steps saw is found within it.
double PathProver::first_reach(const core::stepper::Simulation& simulation) const {
    const double contact = model_.dmin + model_.dhat;
    double reach = std::min(contact, known_);
    for (const auto& step : simulation.report.steps) reach = std::min(reach, step.minimum_distance);
    reach *= 1 + share;
    return reach > model_.dmin ? reach : contact;
}

// @return false: it was stopped
bool PathProver::prove(const core::stepper::Simulation& simulation, Stretch& stretch, double reach) {
    const auto options = proof_options(share * reach, should_stop_);
    const bool all = stretch.first == stretch.last;
    const core::clearance::NearClearances near =
        all ? certify_near(model_, simulation.trajectory, reach, options)
            : certify_near(model_, simulation.trajectory, {stretch.first, stretch.last}, reach, options);
    Judgement judged = judge(model_, near.windows, near.everything ? infinity : reach);
    if (!judged.whole && should_stop_()) return false;
    stretch.reach = reach;
    stretch.judged = std::move(judged);
    known_ = std::min(known_, stretch.judged.upper);
    return true;
}

// Goes on to this step. @return false: it was stopped
bool PathProver::prove_steps(const core::stepper::Simulation& simulation, int last) {
    Stretch next;
    next.first = stretches_.empty() ? 0 : stretches_.back().last;
    next.last = last;
    if (!prove(simulation, next, first_reach(simulation))) return false;
    stretches_.push_back(std::move(next));
    return true;
}

void PathProver::follow(const core::stepper::Simulation& so_far) {
    if (!any_pair_ || should_stop_()) return;
    const Stopwatch watch(seconds_);
    const auto steps = count_of(so_far.trajectory.steps);
    for (int last = (stretches_.empty() ? 0 : stretches_.back().last) + stretch_; last <= steps; last += stretch_)
        if (!prove_steps(so_far, last)) return;
}

double PathProver::lower() const {
    double lower = infinity;
    for (const Stretch& stretch : stretches_) lower = std::min(lower, stretch.judged.lower);
    return lower;
}

PathProof PathProver::stopped() const {
    PathProof proof{ProofState::stopped, std::nullopt, "the proof of the path was stopped on request", 0};
    for (const Stretch& stretch : stretches_) {
        if (!stretch.judged.open.empty()) break;
        proof.lower = std::min(proof.lower.value_or(infinity), stretch.judged.lower);
        proof.steps = stretch.last;
    }
    return proof;
}

// Proves the surfaces alone of pairs of which one may lie inside the other, whose mesh is not closed.
PathProof PathProver::proven(double lower, std::vector<PairRequest> unverified, int steps) const {
    if (unverified.empty()) return {ProofState::proven, lower, {}, steps};
    make_unique(unverified);
    const std::size_t others = unverified.size() - 1;
    return {ProofState::surfaces, lower,
            "of " + both_names(model_, unverified.front().a, unverified.front().b) +
                (others > 0 ? " (and " + core::base::counted(others, "more pair") + ")" : "") + ": " +
                core::clearance::why_not_apart(core::clearance::Solids::unverified),
            steps};
}

std::vector<PairRequest> PathProver::unverified() const {
    std::vector<PairRequest> pairs;
    for (const Stretch& stretch : stretches_) pairs.insert(pairs.end(), stretch.judged.unverified.begin(), stretch.judged.unverified.end());
    return pairs;
}

// Pairs that are left open are searched again, a hundred times closer each time.
PathProof PathProver::look_closer(const core::stepper::Simulation& simulation) {
    Judgement judged;
    double tolerance = infinity;
    for (const Stretch& stretch : stretches_) {
        const Judgement& other = stretch.judged;
        if (judged.reason.empty()) judged.reason = other.reason;
        judged.lower = std::min(judged.lower, other.lower);
        judged.settled = std::min(judged.settled, other.settled);
        judged.is_final = judged.is_final || other.is_final;
        judged.open.insert(judged.open.end(), other.open.begin(), other.open.end());
        tolerance = std::min(tolerance, share * stretch.reach);
    }
    make_unique(judged.open);
    std::vector<PairRequest> unverified = this->unverified();
    for (int round = 1; !judged.is_final && round < most_rounds; ++round) {
        tolerance *= 1e-2;
        const auto options = proof_options(tolerance, should_stop_);
        judged = judge(model_, core::clearance::certify(model_, simulation.trajectory, judged.open, options), judged.settled);
        if (!judged.whole && should_stop_()) return stopped();
        unverified.insert(unverified.end(), judged.unverified.begin(), judged.unverified.end());
        if (judged.open.empty()) return proven(judged.settled, std::move(unverified), count_of(simulation.trajectory.steps));
    }
    PathProof proof = stopped();  // as far as it goes
    return {ProofState::not_certified, judged.lower, judged.reason, proof.steps};
}

PathProof PathProver::finish(const core::stepper::Simulation& simulation) {
    if (!any_pair_) return {};
    const Stopwatch watch(seconds_);
    return finished(simulation);
}

PathProof PathProver::finished(const core::stepper::Simulation& simulation) {
    const auto steps = count_of(simulation.trajectory.steps);
    const int done = stretches_.empty() ? 0 : stretches_.back().last;
    if ((steps > done || stretches_.empty()) && !prove_steps(simulation, steps)) return stopped();
    double reach = first_reach(simulation);
    for (int round = 1;; ++round) {
        const auto is_open = [](const Stretch& stretch) { return !stretch.judged.open.empty(); };
        if (std::any_of(stretches_.begin(), stretches_.end(), is_open)) return look_closer(simulation);
        const auto tells = [&](const Stretch& stretch) { return stretch.tells(known_); };
        if (round == most_reaches || std::all_of(stretches_.begin(), stretches_.end(), tells)) break;
        reach = known_ <= reach ? known_ : std::min(known_, 8 * reach);
        for (Stretch& stretch : stretches_)
            if (!tells(stretch) && !prove(simulation, stretch, reach)) return stopped();
    }
    return proven(lower(), unverified(), steps);
}

PathProof prove_path(const core::model::Model& model, const core::stepper::Simulation& simulation,
                     const std::function<bool()>& should_stop) {
    return PathProver(model, should_stop).finish(simulation);
}

}  // namespace fettle::design::clearance
