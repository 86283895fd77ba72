// SPDX-License-Identifier: MIT
#include "fettle/design/cli/clearance_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "fettle/core/base/units.hpp"
#include "fettle/core/files/json_document.hpp"
#include "fettle/core/model/start_check.hpp"
#include "fettle/design/cli/answers.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::clearance::PairClearance;
using core::clearance::PairStatus;
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

// The whole pair: the least of its members.
PairClearance least_of(const std::vector<PairClearance>& members) {
    PairClearance least = members.front();
    for (const PairClearance& member : members) {
        const PairClearance before = least;
        if (member.upper < before.upper) least = member;
        least.lower = std::min(before.lower, member.lower);
        least.sampled = std::min(before.sampled, member.sampled);
        least.complete = before.complete && member.complete;
        least.intersecting = before.intersecting || member.intersecting;
        least.status = severity(member.status) < severity(before.status) ? member.status : before.status;
    }
    return least;
}

// Surfaces that never meet leave one thing to ask: does one body lie inside the other? Then it does at the start.
// `model`: one without minimum separation.
std::string overlap_at_start(const core::model::Model& model, const std::vector<PairClearance>& members) {
    for (const PairClearance& member : members) {
        if (!(member.lower > 0)) continue;
        if (const auto error = core::model::check_start_pair(model, member.a, member.b)) return error->message;
    }
    return {};
}

Finding finding_of(const Subject& subject, const ReportedPair& pair) {
    const PairClearance& least = pair.least;
    if (least.intersecting || !pair.overlap.empty()) return Finding::clash;
    if (least.status == PairStatus::clear) return Finding::clear;
    if (least.status == PairStatus::contact) return Finding::contact;
    const bool pushes =
        std::any_of(pair.members.begin(), pair.members.end(), [&](const PairClearance& m) { return may_push(subject, m.a, m.b); });
    if (!pair.spec.named && pushes && least.upper < subject.model.dhat + subject.model.dmin) return Finding::contact;
    return least.status == PairStatus::violated ? Finding::below : Finding::undecided;
}

PairStatus status_of(Finding finding) {
    switch (finding) {
        case Finding::clash:
        case Finding::below:
            return PairStatus::violated;
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
    for (int row = 0; row < 3; ++row) rotation.push_back(vector_json(pose.rotation.row(row).transpose()));
    return {{"position", vector_json(pose.position)}, {"rotation", rotation}};
}

const char* word(core::clearance::Primitive primitive) {
    const char* words[] = {"vertex", "edge", "triangle"};
    return words[static_cast<int>(primitive)];
}

Json witness_json(const Witness& w) {
    Json json{{"time", w.time}, {"step", w.step}, {"segment", w.segment}, {"s", w.s}};
    json["feature_a"] = {{"kind", word(w.kind_a)}, {"index", w.primitive_a}};
    json["feature_b"] = {{"kind", word(w.kind_b)}, {"index", w.primitive_b}};
    json["point_a"] = vector_json(w.point_a);
    json["point_b"] = vector_json(w.point_b);
    return json;
}

Json pair_json(const ReportedPair& pair, const Subject& subject, const std::vector<std::string>& names) {
    const PairClearance& least = pair.least;
    Json json;
    json["a"] = pair.spec.a.name;
    json["b"] = pair.spec.b.name;
    json["minimum"] = least.minimum;
    json["required_by"] = pair.spec.required_by;
    json["lower"] = least.lower;
    json["upper"] = least.upper;
    json["status"] = core::clearance::to_string(least.status);
    json["finding"] = to_string(pair.finding);
    json["time"] = least.witness.time;
    json["point_a"] = vector_json(least.witness.point_a);
    json["point_b"] = vector_json(least.witness.point_b);
    json["gap"] = least.upper - least.lower;
    json["sampled"] = least.sampled;
    json["complete"] = least.complete;
    if (!pair.overlap.empty()) json["overlap"] = pair.overlap;
    if (pair.spec.a.is_group) json["body_a"] = names[static_cast<size_t>(least.a)];
    if (pair.spec.b.is_group) json["body_b"] = names[static_cast<size_t>(least.b)];
    json["pose_a"] = pose_json(file_pose(subject, least.witness, least.a));
    json["pose_b"] = pose_json(file_pose(subject, least.witness, least.b));
    json["witness"] = witness_json(least.witness);
    if (!least.witnesses.empty()) {
        json["witnesses"] = Json::array();
        for (const Witness& witness : least.witnesses) json["witnesses"].push_back(witness_json(witness));
    }
    if (!pair.change.empty()) json["change"] = pair.change;
    if (pair.before) json["before"] = {{"status", pair.before->status}, {"lower", pair.before->lower}, {"upper", pair.before->upper}};
    return json;
}

int count_changes(const ClearanceReport& report, const char* change) {
    return static_cast<int>(
        std::count_if(report.pairs.begin(), report.pairs.end(), [&](const ReportedPair& p) { return p.change == change; }));
}

bool is_finding(const std::string& status) { return status == "violated" || status == "undecided"; }

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
                            double tolerance) {
    ClearanceReport report;
    report.ignored = selection.ignored;
    report.left_out = selection.left_out;
    report.tolerance = tolerance;
    core::model::Model touching_allowed = subject.model;
    touching_allowed.dmin = 0;
    size_t next = 0;
    const auto set_time = [&](Witness& w) { w.time = core::stepper::time_at(subject.trajectory, w.step, w.segment, w.s); };
    for (const PairSpec& spec : selection.pairs) {
        ReportedPair pair;
        pair.spec = spec;
        for (size_t i = 0; i < spec.body_pairs.size(); ++i) {
            pair.members.push_back(results[next++]);
            set_time(pair.members.back().witness);  // where times are uneven only the trajectory knows them
            for (Witness& witness : pair.members.back().witnesses) set_time(witness);
        }
        pair.least = least_of(pair.members);
        if (!pair.least.intersecting) pair.overlap = overlap_at_start(touching_allowed, pair.members);
        if (!pair.overlap.empty()) pair.least.lower = pair.least.upper = 0;
        pair.finding = finding_of(subject, pair);
        pair.least.status = status_of(pair.finding);
        if (pair.least.status == PairStatus::violated) report.status = PairStatus::violated;
        if (pair.least.status == PairStatus::undecided && report.status == PairStatus::clear) report.status = PairStatus::undecided;
        report.pairs.push_back(std::move(pair));
    }
    if (!subject.incomplete.empty() && report.status == PairStatus::clear) report.status = PairStatus::undecided;
    std::stable_sort(report.pairs.begin(), report.pairs.end(), [](const ReportedPair& x, const ReportedPair& y) {
        return x.finding != y.finding ? x.finding < y.finding : share(x) < share(y);
    });
    return report;
}

Errors compare_with_baseline(const std::string& path, ClearanceReport& report) {
    auto document = core::files::JsonDocument::read(path);
    if (!document) return document.errors();
    report.baseline = path;
    const core::files::JsonNode list = document->root().require("pairs");
    for (const core::files::JsonNode& node : list.elements()) {
        const auto a = node.require("a").string(), b = node.require("b").string();
        const auto status = node.require("status").choice({"clear", "violated", "undecided", "contact"});
        const auto lower = node.require("lower").number(), upper = node.require("upper").number();
        if (!a || !b || !status || !lower || !upper) continue;
        const auto found = std::find_if(report.pairs.begin(), report.pairs.end(), [&](const ReportedPair& p) {
            return (p.spec.a.name == *a && p.spec.b.name == *b) || (p.spec.a.name == *b && p.spec.b.name == *a);
        });
        if (found != report.pairs.end()) {
            found->before = Before{*status, *lower, *upper};
        } else if (is_finding(*status)) {
            report.missing.push_back(*a + ":" + *b);
        }
    }
    for (ReportedPair& pair : report.pairs) {
        const bool now = is_finding(core::clearance::to_string(pair.least.status)), then = pair.before && is_finding(pair.before->status);
        pair.change = now ? (then ? "existing" : "new") : (then ? "resolved" : "");
    }
    return document->errors();
}

Json report_json(const ClearanceReport& report, const Subject& subject) {
    const std::vector<std::string> names = body_names(subject.model);
    double minimum = std::numeric_limits<double>::infinity(), least = minimum;
    Json list = Json::array();
    for (const ReportedPair& pair : report.pairs) {
        minimum = std::min(minimum, pair.least.minimum);
        least = std::min(least, pair.least.lower);
        list.push_back(pair_json(pair, subject, names));
    }
    Json json;
    json["status"] = core::clearance::to_string(report.status);
    json["minimum"] = report.pairs.empty() ? Json() : Json(minimum);
    json["least"] = report.pairs.empty() ? Json() : Json(least);
    json["tolerance"] = report.tolerance;
    json["motion"] = subject.motion();
    json["source"] = to_string(subject.source);
    json["steps"] = subject.trajectory.steps.size();
    json["pairs"] = list;
    json["ignored"] = report.ignored;
    json["left_out"] = report.left_out;
    json["notes"] = subject.notes;
    if (!subject.incomplete.empty()) json["message"] = "the motion is known up to there only: " + subject.incomplete;
    if (!report.baseline.empty()) {
        json["baseline"] = {{"file", report.baseline},
                            {"new", count_changes(report, "new")},
                            {"existing", count_changes(report, "existing")},
                            {"resolved", count_changes(report, "resolved")},
                            {"missing", report.missing}};
    }
    return json;
}

}  // namespace fettle::design::cli
