// SPDX-License-Identifier: MIT
#include "core/clearance/jointed_clearance.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "core/base/limits.hpp"
#include "core/certificate/joint_prover.hpp"

namespace fettle::core::clearance {
namespace {

using base::infinity;
using certificate::IdealJoints;

constexpr double claimed_room = 1 + 1e-6;  // for another processor's library of sines

bool is_wholly(const model::Body& body, bool free) {
    for (int dof = 0; dof < 6; ++dof)
        if (is_free(body, dof) != free) return false;
    return true;
}

// The frames and measures that rows use, renumbered.
class Gathering {
public:
    explicit Gathering(const model::Mechanism& mechanism) : mechanism_(mechanism) {}

    IdealJoints joints;

    std::set<int> bodies_of(const constraint::Row& row) const {
        std::set<int> out;
        for (const constraint::RowPart& part : row.parts) {
            const measure::Measure& m = mechanism_.set.measures[part.measure];
            for (const int frame : {m.a, m.b}) out.insert(mechanism_.set.frames[frame].body);
        }
        out.erase(measure::world);
        return out;
    }

    void add(const constraint::Row& row) {
        constraint::Row copy = row;
        for (constraint::RowPart& part : copy.parts) part.measure = place_of_measure(part.measure);
        copy.owner = -1;
        copy.length = 1;
        joints.rows.push_back(std::move(copy));
    }

private:
    int place_of_measure(int measure) {
        const auto [known, is_new] = measures_.try_emplace(measure, count_of(joints.set.measures));
        if (is_new) {
            measure::Measure copy = mechanism_.set.measures[measure];
            copy.a = place_of_frame(copy.a);
            copy.b = place_of_frame(copy.b);
            joints.set.measures.push_back(copy);
        }
        return known->second;
    }

    int place_of_frame(int frame) {
        const auto [known, is_new] = frames_.try_emplace(frame, count_of(joints.set.frames));
        if (is_new) joints.set.frames.push_back(mechanism_.set.frames[frame]);
        return known->second;
    }

    const model::Mechanism& mechanism_;
    std::map<int, int> frames_, measures_;
};

/// Nothing is known of it.
PairClearance unbounded(PairClearance pair, double minimum, const std::string& reason) {
    pair.minimum = minimum;
    pair.lower = 0;
    pair.upper = infinity;
    pair.is_bounded = pair.is_far = pair.intersecting = false;
    pair.overlap.reset();
    pair.touch.reset();
    pair.solids = Solids::unproven;
    pair.margin.clear();
    pair.status = PairStatus::undecided;
    pair.reason = reason;
    return pair;
}

PairClearance undecided(PairClearance pair, const std::string& reason) {
    pair.intersecting = false;
    pair.overlap.reset();
    if (pair.solids == Solids::overlap || !(pair.lower > 0)) pair.solids = Solids::unproven;
    pair.status = PairStatus::undecided;
    pair.reason = reason;
    return pair;
}

const char* const between_nodes = "joints part too far between the nodes of the path for a proof; use shorter steps";

// From bounds along the path, judged with a minimum raised by the charge.
PairClearance charged(PairClearance pair, double minimum, double charge) {
    pair.minimum = minimum;
    if (!(charge > 0)) return pair;
    const bool was_clash = pair.is_clash(), is_deep = pair.overlap && pair.overlap->depth_lower > charge, was_apart = pair.lower > 0;
    pair.lower = std::max(0.0, pair.lower - charge);
    pair.upper += charge;
    for (MarginInterval& interval : pair.margin) {
        interval.lower = std::max(0.0, interval.lower - charge);
        interval.upper += charge;
    }
    pair.clash_not_before = 0;  // of the path's own clash
    const bool was_touching = pair.touch.has_value();
    if (was_touching && !(pair.touch->room > charge)) pair.touch.reset();
    if (pair.touch && pair.status == PairStatus::contact) return pair;
    if (was_clash) return is_deep ? pair : undecided(std::move(pair), between_nodes);
    if (pair.status == PairStatus::undecided) {
        if (pair.lower > 0 || pair.touch) return pair;
        return undecided(pair, was_apart || was_touching ? between_nodes : pair.reason);
    }
    // What touches on the path and was found in each other there is not known to be so where the joints have it.
    if (pair.status == PairStatus::violated ? pair.upper < minimum : pair.lower > 0 && pair.lower >= minimum) return pair;
    return undecided(std::move(pair), between_nodes);
}

}  // namespace

base::Result<IdealJoints> ideal_joints(const model::Model& model, const std::vector<std::string>& held) {
    Gathering gathering(model.mechanism);
    const std::set<std::string> still(held.begin(), held.end());
    const auto body_of = [&](int i) -> const model::Body& { return model.bodies[i]; };
    std::set<int> moved;
    for (const constraint::Row& row : model.mechanism.rows) {
        const std::set<int> bodies = gathering.bodies_of(row);
        if (std::any_of(bodies.begin(), bodies.end(), [&](int i) { return still.count(body_of(i).name) > 0; })) continue;
        gathering.add(row);
        for (const int i : bodies) {
            if (is_wholly(body_of(i), false)) continue;
            if (!is_wholly(body_of(i), true))
                return base::Error{base::ErrorCode::unsupported, "joints",
                                   "'" + body_of(i).name + "' has prescribed coordinates beside joints"};
            moved.insert(i);
        }
    }
    gathering.joints.bodies.assign(moved.begin(), moved.end());
    if (gathering.joints.rows.size() != 6 * moved.size())
        return base::Error{base::ErrorCode::unsupported, "joints", "joints and motors do not determine every body that they move"};
    return std::move(gathering.joints);
}

std::vector<int> jointed_bodies(const model::Model& model, const std::vector<std::string>& held) {
    const Gathering gathering(model.mechanism);
    const auto is_held = [&](int i) { return std::count(held.begin(), held.end(), model.bodies[i].name) > 0; };
    std::set<int> out;
    for (const constraint::Row& row : model.mechanism.rows)
        for (const int i : gathering.bodies_of(row))
            if (!is_wholly(model.bodies[i], false) && !is_held(i)) out.insert(i);
    return {out.begin(), out.end()};
}

JointedPath jointed_path(const model::Model& model, const stepper::JointedMotion& motion) {
    JointedPath out;
    out.bodies = jointed_bodies(model, motion.held);
    auto joints = ideal_joints(model, motion.held);
    if (!joints) {
        out.refusal = joints.errors().front().message;
        return out;
    }
    joints->deviations.assign(joints->bodies.size(), 0.0);
    if (const base::Errors errors = check_joints(*joints, model.bodies.size()); !errors.empty()) {
        out.refusal = errors.front().message;
        return out;
    }
    certificate::ProvenDeviations proven = prove_deviations(*joints, model, motion.trajectory);
    out.refusal = proven.fault;
    if (!out.refusal.empty()) return out;
    for (std::size_t i = 0; i < proven.of_body.size(); ++i) joints->deviations[i] = claimed_room * proven.of_body[i];
    out.joints = std::move(joints).value();
    return out;
}

namespace {

double charge_of(const JointedPath& path, const PairRequest& pair) { return path.joints ? joint_charge(*path.joints, pair.a, pair.b) : 0; }

std::vector<PairRequest> widened(std::vector<PairRequest> pairs, const JointedPath& path) {
    for (PairRequest& pair : pairs) {
        const double charge = charge_of(path, pair);
        if (pair.minimum > 0) pair.minimum += charge;
        pair.far += charge;
        pair.charge = charge;
    }
    return pairs;
}

// Is nothing proven of this pair, for want of joints?
bool is_unproven(const JointedPath& path, int a, int b) {
    const auto has = [&](int body) { return std::binary_search(path.bodies.begin(), path.bodies.end(), body); };
    return !path.joints && (has(a) || has(b));
}

void judge_jointed(const std::vector<PairRequest>& pairs, const JointedPath& path, std::vector<PairClearance>& results) {
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (is_unproven(path, pairs[i].a, pairs[i].b)) {
            results[i] = unbounded(
                std::move(results[i]), required_gap(pairs[i]),
                "where the bodies are between the nodes of the path, if joints are met at all times, is not proven: " + path.refusal);
        } else {
            results[i] = charged(std::move(results[i]), required_gap(pairs[i]), charge_of(path, pairs[i]));
        }
    }
}

}  // namespace

std::vector<PairClearance> certify(const model::Model& model, const stepper::Trajectory& trajectory, const JointedPath& path,
                                   const std::vector<PairRequest>& pairs, const ClearanceOptions& options) {
    std::vector<PairClearance> results = certify(model, trajectory, widened(pairs, path), options);
    judge_jointed(pairs, path, results);
    return results;
}

ProvenClearances certify_with_proof(const model::Model& model, const stepper::Trajectory& trajectory, const JointedPath& path,
                                    const std::vector<PairRequest>& pairs, const ClearanceOptions& options) {
    ProvenClearances proven = certify_with_proof(model, trajectory, widened(pairs, path), options);
    judge_jointed(pairs, path, proven.pairs);
    proven.certificate.joints = path.joints;
    proven.certificate.is_of_path = !path.joints;
    std::erase_if(proven.certificate.pairs, [&](const certificate::PairCertificate& pair) { return is_unproven(path, pair.a, pair.b); });
    return proven;
}

}  // namespace fettle::core::clearance
