// SPDX-License-Identifier: MIT
#include "fettle/design/cli/clearance_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fettle/core/base/text.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/range_clearance.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/cli/rounded_lengths.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::base::joined;
using core::certificate::LinkageCoordinate;
using core::clearance::JointRanges;
using core::clearance::PairStatus;
using core::clearance::RangeClearance;
using core::model::Model;

constexpr double degrees = 180 / std::numbers::pi;

struct RangeRow {
    PairSpec spec;
    RangeClearance least;  // of the pair of bodies that is worst; bounds and status of the whole row
    Change change;         // against the baseline
};

struct RangeReport {
    std::vector<RangeRow> rows;  // worst first
    PairStatus status = PairStatus::clear;
    std::vector<std::string> ignored, left_out, uncovered, notes;
    std::string message;
    std::optional<Baseline> baseline;
    double tolerance = 0;
};

int rank_of(PairStatus status) { return status == PairStatus::violated ? 0 : status == PairStatus::undecided ? 1 : 2; }

const char* finding_word(const RangeClearance& pair) {
    if (pair.is_clash()) return "clash";
    return pair.status == PairStatus::violated ? "below threshold" : core::clearance::to_string(pair.status);
}

RangeClearance worst_of(const std::vector<RangeClearance>& members) {
    RangeClearance least = members.front();
    for (const RangeClearance& member : members) {
        const RangeClearance before = least;
        if (member.is_clash() > before.is_clash() || (member.is_clash() == before.is_clash() && member.upper < before.upper))
            least = member;
        least.lower = std::min(before.lower, member.lower);
        least.upper = std::min(before.upper, member.upper);
        least.complete = before.complete && member.complete;
        least.status = rank_of(member.status) < rank_of(before.status) ? member.status : before.status;
        if (least.reason.empty()) least.reason = before.reason.empty() ? member.reason : before.reason;
    }
    return least;
}

std::vector<std::string> notes_of(const Model& model, const JointRanges& ranges) {
    std::vector<std::string> notes, turns, motors;
    if (!ranges.held.empty()) notes.push_back("held at the start pose, as no joint connects them to the world: " + joined(ranges.held));
    for (const LinkageCoordinate& c : ranges.linkage.coordinates)
        if (c.is_whole_turn) turns.push_back(c.joints.front().joint);
    if (!turns.empty()) notes.push_back("without limits, so over whole turns: " + joined(turns));
    for (const auto& joint : model.mechanism.joints)
        if (joint.is_motor) motors.push_back(joint.name);
    if (!motors.empty()) notes.push_back("what motors do counts for nothing here, limits do: " + joined(motors));
    return notes;
}

RangeReport make_range_report(const Model& model, const JointRanges& ranges, const PairSelection& selection,
                              const std::vector<RangeClearance>& results) {
    RangeReport report;
    auto next = results.begin();
    for (const PairSpec& spec : selection.pairs) {
        const auto last = next + static_cast<std::ptrdiff_t>(spec.body_pairs.size());
        report.rows.push_back({spec, worst_of({next, last}), {}});
        next = last;
    }
    std::stable_sort(report.rows.begin(), report.rows.end(), [](const RangeRow& x, const RangeRow& y) {
        if (rank_of(x.least.status) != rank_of(y.least.status)) return rank_of(x.least.status) < rank_of(y.least.status);
        return x.least.is_clash() != y.least.is_clash() ? x.least.is_clash() : x.least.lower < y.least.lower;
    });
    if (!report.rows.empty()) report.status = report.rows.front().least.status;
    report.ignored = selection.ignored;
    report.left_out = pair_names(selection.left_out);
    report.uncovered = uncovered_pairs(model, selection);
    report.notes = notes_of(model, ranges);
    if (report.rows.empty()) report.message = "nothing was judged: no pair of bodies may collide; name pairs with --pairs";
    if (interrupted()) report.message = "interrupted: what was not looked at is undecided";
    if (!report.message.empty() && report.status == PairStatus::clear) report.status = PairStatus::undecided;
    return report;
}

void compare_with(Baseline baseline, RangeReport& report) {
    for (RangeRow& row : report.rows) row.change = baseline.compare(row.spec.a.name, row.spec.b.name, row.least.status);
    report.baseline = std::move(baseline);
}

// Each joint's own coordinate where the pair is worst: geared ones, too.
template <class Visit>
void for_joints(const JointRanges& ranges, const RangeClearance& pair, const Visit& visit) {
    for (size_t k = 0; k < pair.coordinates.size(); ++k) {
        const LinkageCoordinate& c = ranges.linkage.coordinates[static_cast<size_t>(pair.coordinates[k])];
        for (const auto& joint : c.joints) visit(joint, joint.scale * pair.at[k] + joint.offset, c);
    }
}

Json coordinates_json(const JointRanges& ranges, const RangeClearance& pair) {
    Json list = Json::array();
    for_joints(ranges, pair, [&](const auto& joint, double value, const LinkageCoordinate& c) {
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

Json pose_at(const Model& model, const JointRanges& ranges, const RangeClearance& pair, int body) {
    const core::kinematics::Pose pose = pose_at_witness(model, ranges, pair, body);
    const Vector3 place = core::kinematics::world_position(pose, -model.bodies[static_cast<size_t>(body)].reference_point);
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) rotation.push_back(answers::vector_json(pose.rotation.row(row).transpose()));
    return {{"position", answers::vector_json(place)}, {"rotation", rotation}};
}

// Of all bodies that the pair's joints move there.
Json moved_poses(const Model& model, const JointRanges& ranges, const RangeClearance& pair) {
    Json json = Json::object();
    for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
        const core::kinematics::Pose at = pose_at_witness(model, ranges, pair, body);
        const core::kinematics::Pose& start = model.bodies[static_cast<size_t>(body)].pose_start;
        if (at.position == start.position && at.rotation == start.rotation) continue;
        json[model.bodies[static_cast<size_t>(body)].name] = pose_at(model, ranges, pair, body);
    }
    return json;
}

Json feature_json(core::clearance::Primitive kind, int index) {
    const char* words[] = {"vertex", "edge", "triangle"};
    return {{"kind", words[static_cast<int>(kind)]}, {"index", index}};
}

Json row_json(const RangeRow& row, const Model& model, const JointRanges& ranges) {
    const RangeClearance& least = row.least;
    const bool required = !row.spec.required_by.empty(), measured = std::isfinite(least.upper);
    Json json;
    json["a"] = row.spec.a.name;
    json["b"] = row.spec.b.name;
    json["minimum"] = required ? Json(least.minimum) : Json();
    json["required_by"] = required ? Json(row.spec.required_by) : Json();
    json["lower"] = least.lower;
    json["upper"] = measured ? Json(least.upper) : Json();
    json["status"] = core::clearance::to_string(least.status);
    json["finding"] = finding_word(least);
    json["solids"] = core::certificate::to_string(least.solids);
    if (least.status == PairStatus::undecided) json["reason"] = least.reason;
    json["complete"] = least.complete;
    json["tolerance"] = least.tolerance;
    json["coordinates"] = coordinates_json(ranges, least);
    if (row.spec.a.is_group) json["body_a"] = model.bodies[static_cast<size_t>(least.a)].name;
    if (row.spec.b.is_group) json["body_b"] = model.bodies[static_cast<size_t>(least.b)].name;
    add_change(json, row.change);
    if (!measured) return json;
    json["gap"] = least.upper - least.lower;
    json["point_a"] = answers::vector_json(least.witness.point_a);
    json["point_b"] = answers::vector_json(least.witness.point_b);
    json["pose_a"] = pose_at(model, ranges, least, least.a);
    json["pose_b"] = pose_at(model, ranges, least, least.b);
    json["poses"] = moved_poses(model, ranges, least);
    json["witness"] = {{"feature_a", feature_json(least.witness.kind_a, least.witness.primitive_a)},
                       {"feature_b", feature_json(least.witness.kind_b, least.witness.primitive_b)}};
    return json;
}

Json ranges_json(const RangeReport& report, const Model& model, const JointRanges& ranges) {
    double minimum = std::numeric_limits<double>::infinity(), least = minimum;
    Json list = Json::array();
    for (const RangeRow& row : report.rows) {
        if (!row.spec.required_by.empty()) minimum = std::min(minimum, row.least.minimum);
        least = std::min(least, row.least.lower);
        list.push_back(row_json(row, model, ranges));
    }
    Json json;
    json["status"] = core::clearance::to_string(report.status);
    json["minimum"] = std::isfinite(minimum) ? Json(minimum) : Json();
    json["least"] = report.rows.empty() ? Json() : Json(least);
    json["tolerance"] = report.tolerance;
    json["motion"] = false;
    json["source"] = "over the ranges of the joints";
    json["pairs"] = std::move(list);
    json["ignored"] = report.ignored;
    json["left_out"] = report.left_out;
    json["uncovered"] = report.uncovered;
    json["notes"] = report.notes;
    if (!report.message.empty()) json["message"] = report.message;
    if (report.baseline) json["baseline"] = report.baseline->json();
    return json;
}

// A row per pair, worst first: bounds rounded to the safe side, and each joint's position where the pair is worst; empty: it moves neither
// body against the other.
std::string ranges_csv(const RangeReport& report, const JointRanges& ranges, const std::string& unit) {
    const RoundedLengths lengths(unit);
    std::vector<std::pair<std::string, bool>> joints;  // name, does it turn
    for (const LinkageCoordinate& c : ranges.linkage.coordinates)
        for (const auto& joint : c.joints) joints.emplace_back(joint.joint, joint.is_angle);
    std::string text = "a,b,required[" + unit + "],lower[" + unit + "],upper[" + unit + "],finding";
    for (const auto& [name, is_angle] : joints) text += "," + core::base::csv_cell(name + (is_angle ? "[deg]" : "[" + unit + "]"));
    text += "\n";
    for (const RangeRow& row : report.rows) {
        const RangeClearance& least = row.least;
        text += core::base::csv_cell(row.spec.a.name) + "," + core::base::csv_cell(row.spec.b.name) + "," +
                (row.spec.required_by.empty() ? "" : formatted("%.9g", least.minimum / lengths.metres())) + "," +
                lengths.shortest(least.lower, Towards::down) + "," +
                (std::isfinite(least.upper) ? lengths.shortest(least.upper, Towards::up) : "") + "," + finding_word(least);
        std::map<std::string, std::string> places;
        for_joints(ranges, least, [&](const auto& joint, double value, const LinkageCoordinate&) {
            places[joint.joint] = formatted("%.9g", joint.is_angle ? value * degrees : value / lengths.metres());
        });
        for (const auto& joint : joints) text += "," + places[joint.first];
        text += "\n";
    }
    return text;
}

std::string combination(const JointRanges& ranges, const RangeClearance& pair, const RoundedLengths& lengths) {
    std::vector<std::string> parts;
    for_joints(ranges, pair, [&](const auto& joint, double value, const LinkageCoordinate&) {
        parts.push_back(joint.joint + (joint.is_angle ? formatted(" %.6g deg", value * degrees)
                                                      : formatted(" %.6g %s", value / lengths.metres(), lengths.unit().c_str())));
    });
    return parts.empty() ? "nothing moves one against the other" : joined(parts);
}

std::string point_text(const Vector3& x, const RoundedLengths& lengths) {
    return formatted("(%.6g, %.6g, %.6g) %s", x.x() / lengths.metres(), x.y() / lengths.metres(), x.z() / lengths.metres(),
                     lengths.unit().c_str());
}

std::string explained_row(const RangeRow& row, const Model& model, const JointRanges& ranges, const RoundedLengths& lengths) {
    const RangeClearance& least = row.least;
    std::string text = row.spec.a.name + ":" + row.spec.b.name + ": " + finding_word(least) + "\n";
    if (least.status == PairStatus::undecided) text += "   undecided: " + least.reason + "\n";
    if (!std::isfinite(least.upper)) return text;
    text += (least.is_clash() ? std::string("   the parts share material")
                              : "   at least " + lengths.fixed(least.lower, Towards::down, 3) + ", at most " +
                                    lengths.fixed(least.upper, Towards::up, 3) + " " + lengths.unit() + " over every combination") +
            "; worst at " + combination(ranges, least, lengths) + "\n";
    if (least.solids == core::clearance::Solids::overlap) return text + "   one lies inside the material of the other\n";
    const auto place = [&](int body, const Vector3& x) {
        return "   of " + model.bodies[static_cast<size_t>(body)].name + " at " + point_text(x, lengths) + "\n";
    };
    return text + place(least.a, least.witness.point_a) + place(least.b, least.witness.point_b);
}

std::string ranges_text(const RangeReport& report, const Model& model, const JointRanges& ranges, int explain, const Console& console) {
    const std::string unit = answers::unit_name(model.length_unit);
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(report.tolerance / model.length_unit) - 1e-9)), 0, 9);
    const RoundedLengths lengths(unit, decimals);
    size_t width = 4;
    for (const RangeRow& row : report.rows) width = std::max(width, row.spec.a.name.size() + row.spec.b.name.size() + 1);
    const int w = static_cast<int>(width);
    std::string text = formatted("%-*s %12s %14s %14s  %-16s  worst at   (lengths in %s)\n", w, "pair", "required", "at least", "at most",
                                 "status", unit.c_str());
    for (const RangeRow& row : report.rows) {
        const RangeClearance& least = row.least;
        text += formatted("%-*s %12s %14s %14s  %s", w, (row.spec.a.name + ":" + row.spec.b.name).c_str(),
                          row.spec.required_by.empty() ? "-" : formatted("%.6g", least.minimum / lengths.metres()).c_str(),
                          least.is_clash() ? "-" : lengths.fixed(least.lower, Towards::down).c_str(),
                          std::isfinite(least.upper) && !least.is_clash() ? lengths.fixed(least.upper, Towards::up).c_str() : "-",
                          console.coloured(formatted("%-16s", finding_word(least)), least.status == PairStatus::clear).c_str());
        text += "  " + combination(ranges, least, lengths);
        if (least.solids == core::clearance::Solids::not_closed) text += std::string("  ") + core::clearance::words(least.solids);
        text += (row.change.word.empty() ? "" : "  " + row.change.word) + "\n";
    }
    int told = 0;
    for (const RangeRow& row : report.rows)
        if (told < explain) text += formatted("\n%d. ", ++told) + explained_row(row, model, ranges, lengths);
    text += formatted("\n%zu pair%s over all positions of the joints, in every combination\n", report.rows.size(),
                      report.rows.size() == 1 ? "" : "s");
    for (const RangeRow& row : report.rows)
        if (row.least.status == PairStatus::undecided)
            text += "undecided: " + row.spec.a.name + ":" + row.spec.b.name + ": " + row.least.reason + "\n";
    if (!report.ignored.empty()) text += "ignored: " + joined(report.ignored) + "\n";
    if (!report.left_out.empty()) text += "not judged, as these may not collide: " + joined(report.left_out) + "; name them with --pairs\n";
    if (!report.uncovered.empty())
        text += "not looked at: " + core::base::counted(report.uncovered.size(), "pair") + " of bodies: " + joined(report.uncovered) + "\n";
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    if (report.baseline) text += report.baseline->text();
    if (!report.message.empty()) text += report.message + "\n";
    return text + "overall: " + core::clearance::to_string(report.status) + "\n";
}

std::vector<Check> range_checks(const RangeReport& report, const JointRanges& ranges, const std::string& unit, const std::string& file) {
    const RoundedLengths lengths(unit);
    std::vector<Check> checks;
    for (const RangeRow& row : report.rows) {
        const RangeClearance& least = row.least;
        Check check{row.spec.a.name + ":" + row.spec.b.name, to_check(least.status), finding_word(least), "", file};
        check.message = least.is_clash() ? "the parts share material at some position of the joints"
                                         : "at least " + lengths.fixed(least.lower, Towards::down) + " " + unit +
                                               " apart over all positions of the joints";
        if (!row.spec.required_by.empty()) check.message += formatted("; required %.6g ", least.minimum / lengths.metres()) + unit;
        check.message += "; worst at " + combination(ranges, least, lengths);
        if (least.status == PairStatus::undecided) check.message += "; undecided: " + least.reason;
        checks.push_back(std::move(check));
    }
    if (!report.message.empty()) checks.push_back(not_judged(report.message, file));
    return checks;
}

Errors write_range_proof(const RangeQuestion& question, core::certificate::Certificate& certificate, const LoadedModel& loaded) {
    certificate.source = name_from_certificate(question.certificate, question.path);
    core::files::FilesTogether files;
    Errors errors = core::records::add_trajectory(files, certificate_trajectory(question.certificate),
                                                  core::clearance::as_assembled(loaded.model), loaded.model, loaded.scene_path);
    if (errors.empty()) errors = core::certificate::add_certificate(files, question.certificate, certificate);
    return errors.empty() ? files.take_names() : errors;
}

}  // namespace

int clearance_over_ranges(RangeQuestion question, const CommonOptions& common, Console& console) {
    std::error_code ignored;
    if (std::filesystem::is_directory(question.path, ignored))
        return console.input_errors(
            {{ErrorCode::unsupported, question.path, "is a folder: --ranges wants a scene or design, whose joints have ranges"}});
    if (file_kind(question.path) == FileKind::trajectory)
        return console.input_errors(
            {{ErrorCode::unsupported, question.path, "a trajectory has no joints: --ranges wants a scene or design"}});
    const Result<LoadedModel> loaded = load_model(question.path, common, false);
    if (!loaded) return console.input_errors(loaded.errors());
    tell_warnings(console, loaded->warnings, question.path);
    Result<JointRanges> ranges = core::clearance::joint_ranges(loaded->model);
    if (!ranges) {
        Errors errors = ranges.errors();
        for (Error& error : errors) error.where = question.path + ": " + error.where;
        return console.input_errors(errors);
    }
    PairOptions pair_options = question.pairs;
    pair_options.motion = true;
    const Result<PairSelection> selection = select_pairs(loaded->model, pair_options);
    if (!selection) return console.input_errors(selection.errors());
    std::vector<core::clearance::PairRequest> requests;
    for (const PairSpec& pair : selection->pairs)
        for (const auto& [a, b] : pair.body_pairs) requests.push_back({a, b, pair.minimum});
    core::clearance::RangeClearanceOptions certify = core::clearance::usual_options(requests);
    if (question.tolerance) {
        certify.tolerance = *question.tolerance;
        certify.coarse = 0;
    }
    certify.on_pair = [&](int done, int of) { console.progress("certifying", done, of); };
    certify.should_stop = interrupted;
    core::certificate::Certificate certificate;
    if (!question.certificate.empty()) certify.certificate = &certificate;
    const std::vector<RangeClearance> results = certify_ranges(loaded->model, *ranges, requests, certify);
    RangeReport report = make_range_report(loaded->model, *ranges, *selection, results);
    report.tolerance = certify.tolerance;
    if (question.baseline) compare_with(*std::move(question.baseline), report);
    if (!question.csv.empty()) {
        const std::string table = ranges_csv(report, *ranges, answers::unit_name(loaded->model.length_unit));
        console.unwritten(core::files::write_file_atomically(question.csv, table));  // the verdict is told all the same
    }
    Json json = ranges_json(report, loaded->model, *ranges);
    if (!loaded->warnings.empty()) json["warnings"] = loaded->warnings;
    std::string text = ranges_text(report, loaded->model, *ranges, question.explain, console);
    Errors no_proof;
    if (!question.certificate.empty()) no_proof = write_range_proof(question, certificate, *loaded);
    console.unwritten(no_proof);
    if (!question.certificate.empty() && no_proof.empty()) {
        json["certificate"] = {{"file", question.certificate}, {"trajectory", certificate_trajectory(question.certificate)}};
        text += "certificate: " + question.certificate + "; check it with fettle validate " + question.certificate + "\n";
    }
    report::Motion assembled{loaded->model, core::clearance::as_assembled(loaded->model), loaded->scene_path};
    console.unwritten(write_folder(question.folder, std::move(assembled), common, console, json, text));
    for (Check& check : range_checks(report, *ranges, answers::unit_name(loaded->model.length_unit), question.path))
        console.found(std::move(check));
    console.result(json, text);
    return exit_code(report.status);
}

}  // namespace fettle::design::cli
