// SPDX-License-Identifier: MIT
#include "design/clearance/report_json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "design/answers/answer_json.hpp"

namespace fettle::design::clearance {

namespace {

using Json = nlohmann::ordered_json;
using core::clearance::PairClearance;
using core::clearance::PairStatus;
using core::clearance::Witness;

Json pose_json(const core::kinematics::Pose& pose) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) rotation.push_back(answers::vector_json(pose.rotation.row(row).transpose()));
    return {{"position", answers::vector_json(pose.position)}, {"rotation", rotation}};
}

Json feature_json(core::clearance::Primitive kind, int index) {
    const char* words[] = {"vertex", "edge", "triangle"};
    return {{"kind", words[static_cast<int>(kind)]}, {"index", index}};
}

Json witness_json(const Witness& w) {
    Json json{{"time", w.time}, {"step", w.step}, {"segment", w.segment}, {"s", w.s}};
    json["feature_a"] = feature_json(w.kind_a, w.primitive_a);
    json["feature_b"] = feature_json(w.kind_b, w.primitive_b);
    json["point_a"] = answers::vector_json(w.point_a);
    json["point_b"] = answers::vector_json(w.point_b);
    return json;
}

// Adds the overlap of a clash of closed bodies.
void add_overlap(Json& json, const PairClearance& pair) {
    if (!pair.overlap) return;
    const core::clearance::Overlap& overlap = *pair.overlap;
    json["depth"] = {{"lower", overlap.depth_lower},
                     {"upper", overlap.depth_upper},
                     {"time", overlap.time},
                     {"point", overlap.depth_lower > 0 ? answers::vector_json(overlap.center) : Json()}};
    json["volume"] = {{"lower", overlap.volume_lower}, {"upper", overlap.volume_upper}};
}

// Where the least distance is, and how it was found.
void add_witness(Json& json, const ReportedPair& pair, const Subject& subject, const std::vector<std::string>& names) {
    const PairClearance& least = pair.least;
    json["time"] = least.is_clash() ? least.clash_time : least.witness.time;
    json["point_a"] = answers::vector_json(least.witness.point_a);
    json["point_b"] = answers::vector_json(least.witness.point_b);
    json["gap"] = least.is_bounded ? Json(least.upper - least.lower) : Json();
    if (subject.domain.joints())
        json["joint_charge"] = subject.domain.joints()->joints ? Json(joint_charge(subject, least.a, least.b)) : Json();
    json["sampled"] = least.sampled;
    json["complete"] = least.complete;
    if (!pair.overlap.empty()) json["overlap"] = pair.overlap;
    if (least.touch) {
        json["touching"] = {
            {"area", least.touch->area}, {"depth", least.touch->depth}, {"time", least.touch->time}, {"allowed", pair.spec.may_touch}};
        if (!least.touch->is_whole) json["touching"]["at_least"] = true;
    }
    if (least.is_clash()) json["clash_not_before"] = least.clash_not_before;
    if (pair.spec.a.is_group) json["body_a"] = names[least.a];
    if (pair.spec.b.is_group) json["body_b"] = names[least.b];
    json["pose_a"] = pose_json(pose_where_nearest(subject, least, least.a));
    json["pose_b"] = pose_json(pose_where_nearest(subject, least, least.b));
    json["witness"] = witness_json(least.witness);
    if (least.witnesses.empty()) return;
    json["witnesses"] = Json::array();
    for (const Witness& witness : least.witnesses) json["witnesses"].push_back(witness_json(witness));
}

Json coordinates_json(const core::clearance::JointRanges& ranges, const PairClearance& pair) {
    Json list = Json::array();
    for_joints(ranges, pair, [&](const auto& joint, double value, const core::certificate::LinkageCoordinate& c) {
        const double low = joint.scale * c.low + joint.offset, high = joint.scale * c.high + joint.offset;
        list.push_back({{"joint", joint.joint},
                        {"value", value},
                        {"unit", joint.is_angle ? "rad" : "m"},
                        {"low", std::min(low, high)},
                        {"high", std::max(low, high)},
                        {"whole_turn", c.is_whole_turn}});
    });
    return list;
}

Json deviations_json(const Subject& subject, const PairClearance& pair) {
    Json list = Json::array();
    for (const WorstDeviation& d : worst_deviations(subject, pair))
        list.push_back({{"of", d.of}, {"value", d.value}, {"lower", d.lower}, {"upper", d.upper}});
    return list;
}

// The poses of all bodies that the pair's joints move, where the pair is worst.
Json moved_poses(const Subject& subject, const PairClearance& pair) {
    Json json = Json::object();
    for (int body = 0; body < count_of(subject.model.bodies); ++body) {
        const core::kinematics::Pose at = core::clearance::pose_at_witness(subject.model, subject.domain, pair, body);
        const core::kinematics::Pose& start = subject.model.bodies[body].pose_start;
        if (at.position == start.position && at.rotation == start.rotation) continue;
        json[subject.model.bodies[body].name] = pose_json(pose_where_nearest(subject, pair, body));
    }
    return json;
}

// Over ranges: the joints' positions where the pair is worst, in place of a time.
void add_worst_position(Json& json, const ReportedPair& pair, const Subject& subject, const std::vector<std::string>& names) {
    const PairClearance& least = pair.least;
    json["complete"] = least.complete;
    json["tolerance"] = least.tolerance;
    json["coordinates"] = coordinates_json(*subject.domain.ranges(), least);
    if (subject.domain.has_deviations() && !least.as_assembled) {
        json["worst_deviations"] = deviations_json(subject, least);
        json["no_influence"] = deviations_without_influence(subject, least);
    }
    if (pair.spec.a.is_group) json["body_a"] = names[least.a];
    if (pair.spec.b.is_group) json["body_b"] = names[least.b];
    if (!std::isfinite(least.upper)) return;
    const Witness& w = least.witness;
    json["gap"] = least.upper - least.lower;
    json["point_a"] = answers::vector_json(w.point_a);
    json["point_b"] = answers::vector_json(w.point_b);
    json["pose_a"] = pose_json(pose_where_nearest(subject, least, least.a));
    json["pose_b"] = pose_json(pose_where_nearest(subject, least, least.b));
    json["poses"] = least.as_assembled ? Json::object() : moved_poses(subject, least);
    json["witness"] = {{"feature_a", feature_json(w.kind_a, w.primitive_a)}, {"feature_b", feature_json(w.kind_b, w.primitive_b)}};
}

// Nothing else is known of a pair that stays far enough apart.
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
    const bool measured = !least.is_far && least.is_bounded && std::isfinite(least.upper);
    json["upper"] = measured ? Json(least.upper) : Json();
    json["status"] = core::clearance::to_string(least.status);
    json["finding"] = to_string(pair.finding);
    json["solids"] = core::certificate::to_string(least.solids);
    if (least.status == PairStatus::undecided && !least.reason.empty()) json["reason"] = least.reason;
    if (subject.domain.is_tree()) {
        add_worst_position(json, pair, subject, names);
    } else if (least.is_far) {
        add_no_witness(json);
    } else {
        add_witness(json, pair, subject, names);
    }
    add_overlap(json, least);
    if (const auto reach = core::clearance::clash_of_facets(subject.model, least)) json["facets_beyond_round"] = *reach;
    if (!pair.joined_by.empty()) json["joined_by"] = pair.joined_by;
    if (const auto parts = true_bounds(subject, pair))
        json["true_surfaces"] = {{"lower", parts->lower},
                                 {"upper", std::isfinite(parts->upper) ? Json(parts->upper) : Json()},
                                 {"lower_is_proven", parts->lower_is_proven},
                                 {"upper_is_proven", parts->upper_is_proven}};
    if (!pair.change.word.empty()) json["change"] = pair.change.word;
    if (const auto& before = pair.change.before)
        json["before"] = {{"status", before->status}, {"lower", before->lower}, {"upper", before->upper}};
    return json;
}

Json joined_json(const JoinedPair& pair, const std::vector<std::string>& names) {
    Json json{{"a", names[pair.a]}, {"b", names[pair.b]}, {"joints", pair.joints}, {"found", to_string(pair.finding)}};
    if (pair.finding == JoinedFinding::apart) json["lower"] = pair.clearance.lower;
    if (pair.finding == JoinedFinding::undecided && !pair.clearance.reason.empty()) json["reason"] = pair.clearance.reason;
    add_overlap(json, pair.clearance);
    return json;
}

}  // namespace

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
    json["source"] = source_text(subject);
    if (subject.domain.has_deviations()) {
        json["tolerances"] = Json::array();
        for (const core::certificate::Deviation& d : subject.domain.made()->deviations)
            json["tolerances"].push_back({{"of", d.of}, {"lower", d.lower}, {"upper", d.upper}});
    }
    if (!subject.domain.is_tree()) json["steps"] = subject.domain.path().steps.size();
    json["pairs"] = std::move(list);
    if (!subject.domain.is_tree()) json["not_measured"] = unmeasured;
    Json deviations = Json::object();
    for (const core::model::Body& body : subject.model.bodies)
        if (const auto& deviation = body.mesh.deviation)
            deviations[body.name] = {{"out", deviation->out},
                                     {"in", deviation->in},
                                     {"out_is_proven", deviation->out_is_proven},
                                     {"in_is_proven", deviation->in_is_proven},
                                     {"declared", deviation->declared}};
    if (!deviations.empty()) json["deviations"] = std::move(deviations);
    json["ignored"] = report.ignored;
    json["ignored_by_scene"] = report.ignored_by_scene;
    json["one_group"] = report.one_group;
    json["joined"] = Json::array();
    for (const JoinedPair& pair : report.joined) json["joined"].push_back(joined_json(pair, names));
    json["left_out"] = report.left_out;
    json["uncovered"] = report.uncovered;
    json["notes"] = report.notes;
    if (!subject.warnings.empty()) json["warnings"] = subject.warnings;
    if (!report.message.empty()) json["message"] = report.message;
    if (const auto& before = report.baseline)
        json["baseline"] = {{"file", before->file()},
                            {"new", before->new_ones()},
                            {"existing", before->existing()},
                            {"resolved", before->resolved()},
                            {"missing", before->missing()}};
    return json;
}

Json proof_json(const PathProof& proof, double seconds) {
    const bool stopped = proof.state == ProofState::stopped;
    const Json lower = proof.lower ? Json(*proof.lower) : Json();
    Json json;
    json["certify_seconds"] = seconds;
    json["minimum_distance"] = stopped ? Json() : lower;
    json["certification"] = to_string(proof.state);
    if (!stopped) return json;
    json["certified_steps"] = proof.steps;
    json["certified_distance"] = lower;
    return json;
}

}  // namespace fettle::design::clearance
