// SPDX-License-Identifier: MIT
#include "fettle/design/cli/clearance_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "fettle/core/base/units.hpp"
#include "fettle/design/answers/answer_json.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::clearance::PairClearance;
using core::clearance::PairStatus;
using core::clearance::Solids;
using core::clearance::Witness;

int severity(PairStatus status) {
    switch (status) {
        case PairStatus::violated:
            return 0;
        case PairStatus::undecided:
            return 1;
        case PairStatus::contact:
            return 2;
        case PairStatus::clear:
            break;
    }
    return 3;
}

bool is_worse(const PairClearance& x, const PairClearance& y) {
    if (x.is_clash() != y.is_clash()) return x.is_clash();
    return x.is_clash() ? x.clash_time < y.clash_time : x.upper < y.upper;
}

Solids worse_of(Solids x, Solids y) {
    for (const Solids each : {Solids::overlap, Solids::unproven, Solids::unverified, Solids::not_closed})
        if (x == each || y == each) return each;
    return Solids::disjoint;
}

std::optional<core::clearance::Touch> both(const std::optional<core::clearance::Touch>& x, const std::optional<core::clearance::Touch>& y) {
    if (!x || !y) return x ? x : y;
    return core::clearance::Touch{x->area + y->area, x->time, std::max(x->depth, y->depth), std::min(x->room, y->room),
                                  x->is_whole && y->is_whole};
}

// The whole pair: the least of its members.
PairClearance least_of(const std::vector<PairClearance>& members) {
    PairClearance least = members.front();
    for (size_t i = 1; i < members.size(); ++i) {
        const PairClearance &member = members[i], before = least;
        if (is_worse(member, before)) least = member;
        least.lower = std::min(before.lower, member.lower);
        least.upper = std::min(before.upper, member.upper);
        least.sampled = std::min(before.sampled, member.sampled);
        least.is_far = before.is_far && member.is_far;
        least.is_bounded = before.is_bounded && member.is_bounded;
        least.complete = before.complete && member.complete;
        least.intersecting = before.intersecting || member.intersecting;
        least.solids = worse_of(before.solids, member.solids);
        least.reason = before.reason.empty() ? member.reason : before.reason;
        least.touch = both(before.touch, member.touch);
        least.status = severity(member.status) < severity(before.status) ? member.status : before.status;
    }
    return least;
}

Finding finding_of(const Subject& subject, const ReportedPair& pair, bool stopped) {
    const PairClearance& least = pair.least;
    const bool pushes =
        std::any_of(pair.members.begin(), pair.members.end(), [&](const PairClearance& m) { return may_push(subject, m.a, m.b); });
    const bool near = !pair.spec.named && pushes && least.upper < subject.model.dhat + subject.model.dmin;
    if (least.is_clash()) return Finding::clash;
    const bool is_worse_apart = std::any_of(pair.members.begin(), pair.members.end(), [](const PairClearance& m) {
        return !m.touch && (m.status == PairStatus::violated || m.status == PairStatus::undecided);
    });
    if (least.touch && !is_worse_apart) return Finding::touching;
    if (least.status == PairStatus::clear) return Finding::clear;
    if (least.lower > 0 && core::certificate::are_apart(least.solids) && (near || least.status == PairStatus::contact))
        return pair.spec.required_by.empty() && !pushes ? Finding::clear : Finding::contact;
    if (near || (stopped && !least.complete)) return Finding::undecided;  // told apart from a clash neither way
    return least.status == PairStatus::violated ? Finding::below : Finding::undecided;
}

PairStatus status_of(const ReportedPair& pair) {
    switch (pair.finding) {
        case Finding::clash:
        case Finding::below:
            return PairStatus::violated;
        case Finding::touching:
            return pair.least.status;
        case Finding::undecided:
            return PairStatus::undecided;
        case Finding::contact:
            return PairStatus::contact;
        case Finding::clear:
            break;
    }
    return PairStatus::clear;
}

// Less is worse: how much of what is required there is.
double share(const ReportedPair& pair) {
    const double distance = pair.finding == Finding::below ? pair.least.upper : pair.least.lower;
    return pair.least.minimum > 0 && pair.finding != Finding::contact ? distance / pair.least.minimum : distance;
}

Json pose_json(const core::kinematics::Pose& pose) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) rotation.push_back(answers::vector_json(pose.rotation.row(row).transpose()));
    return {{"position", answers::vector_json(pose.position)}, {"rotation", rotation}};
}

const char* word(core::clearance::Primitive primitive) {
    const char* words[] = {"vertex", "edge", "triangle"};
    return words[static_cast<int>(primitive)];
}

Json witness_json(const Witness& w) {
    Json json{{"time", w.time}, {"step", w.step}, {"segment", w.segment}, {"s", w.s}};
    json["feature_a"] = {{"kind", word(w.kind_a)}, {"index", w.primitive_a}};
    json["feature_b"] = {{"kind", word(w.kind_b)}, {"index", w.primitive_b}};
    json["point_a"] = answers::vector_json(w.point_a);
    json["point_b"] = answers::vector_json(w.point_b);
    return json;
}

// Where the least distance is, and how it was found.
void add_witness(Json& json, const ReportedPair& pair, const Subject& subject, const std::vector<std::string>& names) {
    const PairClearance& least = pair.least;
    json["time"] = least.is_clash() ? least.clash_time : least.witness.time;
    json["point_a"] = answers::vector_json(least.witness.point_a);
    json["point_b"] = answers::vector_json(least.witness.point_b);
    json["gap"] = least.is_bounded ? Json(least.upper - least.lower) : Json();
    if (subject.joints) json["joint_charge"] = subject.joints->joints ? Json(joint_charge(subject, least.a, least.b)) : Json();
    json["sampled"] = least.sampled;
    json["complete"] = least.complete;
    if (!pair.overlap.empty()) json["overlap"] = pair.overlap;
    if (least.touch) {
        json["touching"] = {
            {"area", least.touch->area}, {"depth", least.touch->depth}, {"time", least.touch->time}, {"allowed", pair.spec.may_touch}};
        if (!least.touch->is_whole) json["touching"]["at_least"] = true;
    }
    if (least.is_clash()) json["clash_not_before"] = least.clash_not_before;
    if (least.overlap) {
        json["depth"] = {{"lower", least.overlap->depth_lower},
                         {"upper", least.overlap->depth_upper},
                         {"time", least.overlap->time},
                         {"point", least.overlap->depth_lower > 0 ? answers::vector_json(least.overlap->center) : Json()}};
        json["volume"] = {{"lower", least.overlap->volume_lower}, {"upper", least.overlap->volume_upper}};
    }
    if (pair.spec.a.is_group) json["body_a"] = names[static_cast<size_t>(least.a)];
    if (pair.spec.b.is_group) json["body_b"] = names[static_cast<size_t>(least.b)];
    json["pose_a"] = pose_json(file_pose(subject, least.witness, least.a));
    json["pose_b"] = pose_json(file_pose(subject, least.witness, least.b));
    json["witness"] = witness_json(least.witness);
    if (least.witnesses.empty()) return;
    json["witnesses"] = Json::array();
    for (const Witness& witness : least.witnesses) json["witnesses"].push_back(witness_json(witness));
}

// Of a pair that stays far enough apart nothing else is known.
void add_no_witness(Json& json) {
    json["measured"] = false;
    for (const char* key : {"time", "point_a", "point_b", "gap", "sampled", "pose_a", "pose_b", "witness"}) json[key] = Json();
    json["complete"] = true;
}

Json pair_json(const ReportedPair& pair, const Subject& subject, const std::vector<std::string>& names) {
    const PairClearance& least = pair.least;
    Json json;
    json["a"] = pair.spec.a.name;
    json["b"] = pair.spec.b.name;
    const bool required = !pair.spec.required_by.empty();
    json["minimum"] = required ? Json(least.minimum) : Json();
    json["required_by"] = required ? Json(pair.spec.required_by) : Json();
    json["lower"] = least.is_bounded ? Json(least.lower) : Json();
    json["upper"] = least.is_far || !least.is_bounded ? Json() : Json(least.upper);
    json["status"] = core::clearance::to_string(least.status);
    json["finding"] = to_string(pair.finding);
    json["solids"] = core::certificate::to_string(least.solids);
    if (least.status == PairStatus::undecided && !least.reason.empty()) json["reason"] = least.reason;
    if (least.is_far) {
        add_no_witness(json);
    } else {
        add_witness(json, pair, subject, names);
    }
    add_change(json, pair.change);
    return json;
}

// Worst first; rows are large, and there may be many.
void sort(std::vector<ReportedPair>& pairs) {
    std::vector<size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) {
        const ReportedPair &x = pairs[i], &y = pairs[j];
        return x.finding != y.finding ? x.finding < y.finding : share(x) < share(y);
    });
    std::vector<ReportedPair> sorted;
    sorted.reserve(pairs.size());
    for (const size_t i : order) sorted.push_back(std::move(pairs[i]));
    pairs = std::move(sorted);
}

// Of bodies of which no pair is looked at unless it is named.
std::string why_no_pair_is_judged(const core::model::Model& model) {
    const bool is_joined = !model.mechanism.not_colliding.empty();
    const bool is_grouped = std::any_of(model.bodies.begin(), model.bodies.end(), [](const auto& body) { return body.group >= 0; });
    if (is_joined && is_grouped) return "of each pair the bodies are of one group, or a joint joins them; name pairs with --pairs";
    return is_joined ? "a joint joins the bodies of each pair; name pairs with --pairs" : "all bodies are of one group";
}

std::string why_not_judged(const Subject& subject, const PairSelection& selection, bool stopped) {
    std::string message;
    if (stopped) message = "interrupted: what was not looked at is undecided";
    if (!subject.incomplete.empty())
        message += (message.empty() ? "" : "; ") + std::string("the motion is known up to there only: ") + subject.incomplete;
    if (selection.pairs.empty())
        message += (message.empty() ? "" : "; ") + std::string("nothing was judged: ") +
                   (subject.model.bodies.size() < 2 ? "there are no two bodies"
                    : !selection.ignored.empty()    ? "every pair is ignored"
                    : !selection.left_out.empty()   ? "no pair may collide in this motion; name pairs with --pairs"
                                                    : why_no_pair_is_judged(subject.model));
    return message;
}

}  // namespace

core::kinematics::Pose file_pose(const Subject& subject, const Witness& witness, int body) {
    const core::kinematics::Pose pose = pose_at(subject.trajectory, witness.step, witness.segment, witness.s, body);
    return {pose.rotation, core::kinematics::world_position(pose, -subject.model.bodies[static_cast<size_t>(body)].reference_point)};
}

const char* to_string(Finding finding) {
    switch (finding) {
        case Finding::clash:
            return "clash";
        case Finding::below:
            return "below threshold";
        case Finding::touching:
            return "touching";
        case Finding::undecided:
            return "undecided";
        case Finding::contact:
            return "contact";
        case Finding::clear:
            break;
    }
    return "clear";
}

ClearanceReport make_report(const Subject& subject, const PairSelection& selection, const std::vector<PairClearance>& results,
                            double tolerance, bool stopped) {
    ClearanceReport report;
    report.ignored = selection.ignored;
    report.left_out = pair_names(selection.left_out);
    report.tolerance = tolerance;
    size_t next = 0;
    const auto set_time = [&](Witness& w) { w.time = core::stepper::time_at(subject.trajectory, w.step, w.segment, w.s); };
    for (const PairSpec& spec : selection.pairs) {
        ReportedPair pair;
        pair.spec = spec;
        for (size_t i = 0; i < spec.body_pairs.size(); ++i) {
            pair.members.push_back(results[next++]);
            if (pair.members.back().is_far) continue;
            set_time(pair.members.back().witness);  // where times are uneven only the trajectory knows them
            for (Witness& witness : pair.members.back().witnesses) set_time(witness);
        }
        pair.least = least_of(pair.members);
        if (pair.least.solids == Solids::overlap) pair.overlap = "one lies inside the material of the other";
        pair.finding = finding_of(subject, pair, stopped);
        pair.least.status = status_of(pair);
        if (pair.least.status == PairStatus::violated) report.status = PairStatus::violated;
        if (pair.least.status == PairStatus::undecided && report.status == PairStatus::clear) report.status = PairStatus::undecided;
        report.pairs.push_back(std::move(pair));
    }
    report.uncovered = uncovered_pairs(subject.model, selection);
    report.message = why_not_judged(subject, selection, stopped);
    if (stopped || (!report.message.empty() && report.status == PairStatus::clear)) report.status = PairStatus::undecided;
    sort(report.pairs);
    return report;
}

void compare_with(Baseline baseline, ClearanceReport& report) {
    for (ReportedPair& pair : report.pairs) pair.change = baseline.compare(pair.spec.a.name, pair.spec.b.name, pair.least.status);
    report.baseline = std::move(baseline);
}

Json report_json(const ClearanceReport& report, const Subject& subject) {
    const std::vector<std::string> names = answers::body_names(subject.model);
    double minimum = std::numeric_limits<double>::infinity(), least = minimum;
    Json list = Json::array();
    int unmeasured = 0;
    bool is_bounded = true;
    for (const ReportedPair& pair : report.pairs) {
        if (!pair.spec.required_by.empty()) minimum = std::min(minimum, pair.least.minimum);
        least = std::min(least, pair.least.lower);
        is_bounded = is_bounded && pair.least.is_bounded;
        unmeasured += pair.least.is_far ? 1 : 0;
        list.push_back(pair_json(pair, subject, names));
    }
    Json json;
    json["status"] = core::clearance::to_string(report.status);
    json["minimum"] = std::isfinite(minimum) ? Json(minimum) : Json();
    json["least"] = report.pairs.empty() || !is_bounded ? Json() : Json(least);
    json["tolerance"] = report.tolerance;
    json["motion"] = subject.motion();
    json["source"] = to_string(subject.source);
    json["steps"] = subject.trajectory.steps.size();
    json["pairs"] = std::move(list);
    json["not_measured"] = unmeasured;
    json["ignored"] = report.ignored;
    json["left_out"] = report.left_out;
    json["uncovered"] = report.uncovered;
    json["notes"] = subject.notes;
    if (!report.message.empty()) json["message"] = report.message;
    if (report.baseline) json["baseline"] = report.baseline->json();
    return json;
}

}  // namespace fettle::design::cli
