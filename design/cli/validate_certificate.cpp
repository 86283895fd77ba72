// SPDX-License-Identifier: MIT
#include "fettle/design/cli/validate_certificate.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/units.hpp"
#include "fettle/core/certificate/range_checker.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/joint_ranges.hpp"
#include "fettle/core/clearance/jointed_clearance.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/certificate_files.hpp"
#include "fettle/design/cli/inputs.hpp"
#include "fettle/design/cli/rounded_lengths.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::certificate::Solids;
using core::model::Model;

struct Claim {
    int a = 0, b = 0;
    double lower = 0, upper = 0;
    Solids solids = Solids::unproven;
    bool is_of_bodies = true;  // false: of the path as stored, and it is not known whether joints have the bodies elsewhere between nodes
};

// What both kinds of certificate come to.
struct Checked {
    core::certificate::CertificateReport report;
    std::uint64_t geometry_hash = 0, path_hash = 0;
    double length_unit = 1;
    std::string source;
    bool motion = false;
    std::optional<core::certificate::Linkage> linkage;     // of one over ranges of joints
    std::optional<core::certificate::IdealJoints> joints;  // met at all times, beside the path
    bool is_of_path = false;                               // and said to be of that
    std::vector<Claim> claims;
    std::vector<std::array<int, 2>> uncovered;
    std::vector<core::certificate::ExportedFile> exports;
};

template <class Certificate>
Checked checked(const Certificate& certificate, const Model& model, core::certificate::CertificateReport report) {
    Checked out;
    out.report = std::move(report);
    out.geometry_hash = certificate.geometry_hash;
    out.path_hash = certificate.path_hash;
    out.length_unit = certificate.length_unit;
    out.source = certificate.source;
    for (const auto& pair : certificate.pairs) out.claims.push_back({pair.a, pair.b, pair.lower, pair.upper, pair.solids});
    out.uncovered = uncovered_pairs(certificate, static_cast<int>(model.bodies.size()));
    return out;
}

Result<Checked> read_and_check(const std::string& path, const core::records::StoredTrajectory& stored) {
    if (core::certificate::is_range_certificate_file(path)) {
        const auto certificate = core::certificate::read_range_certificate(path);
        if (!certificate) return certificate.errors();
        Checked out = checked(*certificate, stored.model, core::certificate::check_range_certificate(*certificate, stored));
        out.linkage = certificate->linkage;
        return out;
    }
    const auto certificate = core::certificate::read_certificate(path);
    if (!certificate) return certificate.errors();
    Checked out = checked(*certificate, stored.model, core::certificate::check_certificate(*certificate, stored));
    out.motion = certificate->motion;
    out.exports = certificate->exports;
    out.joints = certificate->joints;
    out.is_of_path = certificate->is_of_path;
    if (!out.joints) return out;
    for (Claim& claim : out.claims) {
        const double charge = joint_charge(*out.joints, claim.a, claim.b);
        claim.lower = std::max(0.0, claim.lower - charge);
        claim.upper += charge;
        if (!(claim.lower > 0) && claim.solids == Solids::disjoint) claim.solids = Solids::unproven;
    }
    return out;
}

bool moves(const core::stepper::Trajectory& trajectory, int body) {
    const auto i = static_cast<size_t>(body);
    const core::kinematics::Pose& first = trajectory.poses.front()[i];
    for (const auto& step : trajectory.steps)
        for (const auto& node : step.nodes)
            if (node[i].position != first.position || node[i].rotation_vector != Vector3::Zero()) return true;
    return false;
}

// A certificate of a motion that neither has joints nor says that the path as stored is what it is of: what its bounds of moving bodies
// are worth is known only where the source has no joints.
void doubt_bounds(Checked& certificate, const core::stepper::Trajectory& trajectory) {
    for (Claim& claim : certificate.claims) claim.is_of_bodies = !moves(trajectory, claim.a) && !moves(trajectory, claim.b);
}

Json name_of(const Model& model, int body) {
    const bool known = body >= 0 && body < static_cast<int>(model.bodies.size());
    return known ? Json(model.bodies[static_cast<size_t>(body)].name) : Json(body);
}

// "clear", "violated" or "undecided", of a pair whose claims are proven.
const char* verdict(const Claim& pair, double minimum) {
    if (!pair.is_of_bodies) return "undecided";
    if (pair.lower >= minimum && pair.lower > 0 && are_apart(pair.solids)) return "clear";
    return pair.upper < minimum ? "violated" : "undecided";
}

// What a certificate claims, by name.
Json claims_json(const Checked& certificate, const Model& model, const std::optional<double>& minimum) {
    Json list = Json::array();
    for (const Claim& pair : certificate.claims) {
        list.push_back({{"a", name_of(model, pair.a)},
                        {"b", name_of(model, pair.b)},
                        {"lower", pair.lower},
                        {"upper", pair.upper},
                        {"solids", to_string(pair.solids)}});
        if (minimum) list.back()["status"] = verdict(pair, *minimum);
    }
    return list;
}

// "at least 0.4, at most 0.5 mm; disjoint solids"
std::string claim_text(const Json& pair, const RoundedLengths& lengths) {
    const std::string solids = pair["solids"];
    return "at least " + lengths.fixed(pair["lower"], Towards::down) + ", at most " + lengths.fixed(pair["upper"], Towards::up) + " " +
           lengths.unit() + "; " +
           (solids == "disjoint"       ? "disjoint solids"
            : solids == "not closed"   ? "disjoint solids cannot be verified: not closed"
            : solids == "not verified" ? "one may lie inside the other: not closed"
                                       : "not proven to be apart");
}

std::string claims_text(const Json& claims, const Checked& certificate) {
    const RoundedLengths lengths(answers::unit_name(certificate.length_unit));
    std::string text;
    const auto name = [](const Json& body) { return body.is_string() ? body.get<std::string>() : body.dump(); };
    for (const Json& pair : claims) {
        text += "  " + name(pair["a"]) + ":" + name(pair["b"]) + "  " + claim_text(pair, lengths) +
                (pair.contains("status") ? ": " + pair["status"].get<std::string>() : "") + "\n";
    }
    return text;
}

// Are the source's meshes still those of the certificate? Nothing to tell if they are.
struct SourceCheck {
    bool stale = false;
    std::string note;
    bool has_joints = true;  // as far as is known
};

SourceCheck check_source(const Checked& certificate, const std::string& path, const CommonOptions& common) {
    if (certificate.source.empty()) return {};
    const std::filesystem::path source = file_of_certificate(path, certificate.source);
    const std::string untold = ": whether its meshes have changed since cannot be told";
    if (!std::filesystem::exists(source)) return {false, certificate.source + ", which it was made from, is not there" + untold};
    const Result<LoadedModel> loaded = load_model(source.string(), common, false);
    if (!loaded) {
        const Error& error = loaded.errors().front();
        const std::string why = error.where + ": " + error.message;
        // A file that is not found may be elsewhere (--mesh-dir), a program may not be allowed to run: neither says that something changed.
        if (error.code == ErrorCode::file_not_found || error.code == ErrorCode::unsupported) return {false, why + untold};
        return {true, "stale: " + certificate.source + ", which it was made from, can no longer be read: " + why};
    }
    if (core::records::geometry_hash(loaded->model) != certificate.geometry_hash)
        return {true, "stale: the meshes of " + certificate.source + " have changed since"};
    if (certificate.joints) {
        const auto joints = core::clearance::ideal_joints(loaded->model, core::stepper::undriven_bodies(loaded->model));
        if (joints && same_joints(*joints, *certificate.joints)) return {};
        return {true, "stale: the joints or motors of " + certificate.source + " have changed since"};
    }
    if (certificate.motion && loaded->model.mechanism.rows.empty()) return {false, "", false};
    if (certificate.motion && certificate.is_of_path)
        return {false, "its bounds are of the path as stored, between whose nodes joints may part"};
    if (!certificate.linkage) return {};
    const auto ranges = core::clearance::joint_ranges(loaded->model);
    const bool same_start = core::records::path_hash(core::clearance::as_assembled(loaded->model)) == certificate.path_hash;
    if (ranges && ranges->linkage == *certificate.linkage && same_start) return {};
    return {true, "stale: the joints of " + certificate.source + ", their limits or the start poses have changed since"};
}

/// The files that the certificate names: still what they were?
struct ExportCheck {
    Json list = Json::array();       // file, status, rounding
    std::vector<std::string> stale;  // what has changed; empty: nothing
    std::vector<std::string> notes;
};

ExportCheck check_exports(const Checked& certificate, const std::string& path) {
    ExportCheck check;
    for (const core::certificate::ExportedFile& exported : certificate.exports) {
        const std::filesystem::path file = file_of_certificate(path, exported.file);
        const Result<std::string> bytes = core::files::read_file(file);
        const char* status = !bytes ? "not there" : core::files::hash_of(*bytes) == exported.hash ? "same" : "changed";
        check.list.push_back({{"file", exported.file}, {"status", status}, {"rounding", exported.rounding}});
        if (!bytes) {
            check.notes.push_back(exported.file + ", a file of its bodies, is not there or cannot be read");
        } else if (std::string_view(status) == "changed") {
            check.stale.push_back("stale: " + exported.file + ", a file of its bodies, has changed since");
        } else if (exported.rounding > 0) {
            check.notes.push_back(exported.file +
                                  formatted(": its vertices are rounded by up to %.2g mm; between its parts bounds are wider by twice that",
                                            1000 * exported.rounding));
        }
    }
    return check;
}

Result<std::optional<double>> read_minimum(const std::string& text) {
    if (text.empty()) return std::optional<double>{};
    const Result<double> length = core::base::parse_length(text, "--minimum");
    if (!length) return length.errors();
    if (*length < 0) return Error{ErrorCode::out_of_range, "--minimum", "a clearance is not negative"};
    return std::optional<double>(*length);
}

struct Answer {
    Json json, faults = Json::array();
    std::string text;
    bool stale = false;
    double length_unit = 1;  ///< of the certificate
    int code = exit_violated;

    void add_fault(const std::string& where, const std::string& message) {
        faults.push_back({{"where", where}, {"message", message}});
        text += "  " + where + ": " + message + "\n";
    }
};

std::string worst_of(const Json& claims) {
    std::string worst = "clear";
    for (const Json& pair : claims) {
        const std::string status = pair["status"];
        if (status == "violated" || (status == "undecided" && worst == "clear")) worst = status;
    }
    return worst;
}

void check(Checked& certificate, const core::records::StoredTrajectory& stored, const CertificateQuestion& question,
           const std::optional<double>& minimum, const CommonOptions& common, Answer& answer) {
    const core::certificate::CertificateReport& report = certificate.report;
    for (const auto& fault : report.faults) answer.add_fault(fault.where, fault.message);
    answer.stale = report.stale;
    answer.length_unit = certificate.length_unit;
    const SourceCheck source = check_source(certificate, question.path, common);
    if (source.stale) {
        answer.stale = true;
        answer.add_fault("/source", source.note);
    }
    const bool is_doubtful = certificate.motion && !certificate.joints && !certificate.is_of_path && source.has_joints;
    if (is_doubtful) doubt_bounds(certificate, stored.trajectory);
    const ExportCheck exports = check_exports(certificate, question.path);
    for (const std::string& stale : exports.stale) {
        answer.stale = true;
        answer.add_fault("/exports", stale);
    }
    if (!certificate.exports.empty()) answer.json["exports"] = exports.list;
    const bool accepted = answer.faults.empty();
    answer.json["leaves"] = report.leaves;
    answer.json["motion"] = certificate.motion;
    answer.json["pairs"] = claims_json(certificate, stored.model, accepted ? minimum : std::nullopt);
    answer.json["uncovered"] = Json::array();
    std::string uncovered;
    for (const auto& [a, b] : certificate.uncovered) {
        const std::string name = stored.model.bodies[static_cast<size_t>(a)].name + ":" + stored.model.bodies[static_cast<size_t>(b)].name;
        answer.json["uncovered"].push_back(name);
        uncovered += (uncovered.empty() ? "" : ", ") + name;
    }
    answer.json["notes"] = Json::array();
    if (!source.stale && !source.note.empty()) answer.json["notes"].push_back(source.note);
    for (const std::string& note : exports.notes) answer.json["notes"].push_back(note);
    if (is_doubtful)
        answer.json["notes"].push_back(
            "it has no joints, and does not say that the path as stored is all that it is about: of bodies that move nothing is "
            "proven where joints hold them; make it anew");
    if (!accepted) return;
    answer.code = exit_done;
    answer.text += formatted("every claim is proven, in %ld pieces, %s:\n", report.leaves,
                             certificate.linkage                            ? "over all positions of the joints"
                             : certificate.joints                           ? "over the motion, of joints met at all times"
                             : certificate.motion && certificate.is_of_path ? "over the motion, of the path as stored"
                             : certificate.motion                           ? "over the motion"
                                                                            : "as assembled") +
                   claims_text(answer.json["pairs"], certificate);
    if (!uncovered.empty()) answer.text += "not covered: " + uncovered + "\n";
    for (const Json& note : answer.json["notes"]) answer.text += "note: " + note.get<std::string>() + "\n";
    if (!minimum) return;
    const std::string worst = worst_of(answer.json["pairs"]);
    answer.json["minimum"] = *minimum;
    answer.json["judgement"] = worst;
    answer.text += "at a minimum of " + question.minimum + ": " + worst + "\n";
    answer.code = worst == "violated" ? exit_violated : worst == "undecided" ? exit_undecided : exit_done;
}

// Each fault, or, of an accepted certificate, each pair against the minimum.
void tell_checks(const Answer& answer, const CertificateQuestion& question, const std::string& status, Console& console) {
    const std::string& file = question.path;
    for (const Json& fault : answer.faults)
        console.found({fault["where"].get<std::string>(), CheckOutcome::failed, status, fault["message"].get<std::string>(), file});
    if (!answer.faults.empty()) return;
    console.found({file, CheckOutcome::passed, status, "every claim is proven", file});
    const RoundedLengths lengths(answers::unit_name(answer.length_unit));
    const std::string required = question.minimum.empty() ? "" : "; required " + question.minimum;
    for (const Json& pair : answer.json["pairs"]) {
        const std::string judged = pair.contains("status") ? pair["status"].get<std::string>() : "clear";
        const CheckOutcome outcome = judged == "violated"    ? CheckOutcome::failed
                                     : judged == "undecided" ? CheckOutcome::undecided
                                                             : CheckOutcome::passed;
        console.found({pair["a"].get<std::string>() + ":" + pair["b"].get<std::string>(), outcome, judged,
                       claim_text(pair, lengths) + required, file});
    }
}

}  // namespace

int validate_certificate(const CertificateQuestion& question, const CommonOptions& common, Console& console) {
    const Result<std::optional<double>> minimum = read_minimum(question.minimum);
    if (!minimum) return console.input_errors(minimum.errors());
    const std::string trajectory = question.trajectory.empty() ? certificate_trajectory(question.path) : question.trajectory;
    const auto stored = core::records::read_trajectory(trajectory);
    if (!stored) return console.input_errors(stored.errors());
    Answer answer;
    answer.json = {{"status", "rejected"}, {"kind", "certificate"}, {"trajectory", trajectory}};
    Result<Checked> certificate = read_and_check(question.path, *stored);
    for (const Error& error : certificate.errors()) answer.add_fault(error.where, error.message);
    if (certificate) check(*certificate, *stored, question, *minimum, common, answer);
    const bool accepted = answer.faults.empty();
    const std::string status = accepted ? "accepted" : answer.stale ? "stale" : "rejected";
    answer.json["status"] = status;
    answer.json["faults"] = answer.faults;
    tell_checks(answer, question, status, console);
    console.result(answer.json, question.path + ": " + console.coloured(status, accepted) + " for " + trajectory + "\n" + answer.text);
    return answer.code;
}

}  // namespace fettle::design::cli
