// SPDX-License-Identifier: MIT
#include "fettle/design/cli/validate_certificate.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/rounded_lengths.hpp"
#include "fettle/core/base/units.hpp"
#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/joint_ranges.hpp"
#include "fettle/core/clearance/jointed_clearance.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/answers/answer_json.hpp"
#include "fettle/design/clearance/certificate_files.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using core::base::RoundedLengths;
using core::base::Towards;
using core::certificate::Certificate;
using core::certificate::Solids;
using core::clearance::PairStatus;
using core::model::Model;

struct Claim {
    int a = 0, b = 0;
    double lower = 0, upper = 0;
    Solids solids = Solids::unproven;
    bool is_of_bodies = true;  // false: of the path as stored, and it is not known whether joints have the bodies elsewhere between nodes
};

struct Checked {
    core::certificate::Certificate certificate;
    core::certificate::CertificateReport report;
    std::vector<Claim> claims;
};

Result<Checked> read_and_check(const std::string& path, const core::records::StoredTrajectory& stored) {
    auto certificate = core::certificate::read_certificate(path);
    if (!certificate) return certificate.errors();
    Checked out{std::move(certificate).value(), {}, {}};
    out.report = core::certificate::check_certificate(out.certificate, stored);
    for (const auto& pair : out.certificate.pairs) {
        Claim claim{pair.a, pair.b, pair.lower, pair.upper, pair.solids};
        if (const auto& joints = out.certificate.joints) {
            const double charge = joint_charge(*joints, claim.a, claim.b);
            claim.lower = std::max(0.0, claim.lower - charge);
            claim.upper += charge;
            if (!(claim.lower > 0) && claim.solids == Solids::disjoint) claim.solids = Solids::unproven;
        }
        out.claims.push_back(claim);
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
void doubt_bounds(std::vector<Claim>& claims, const core::stepper::Trajectory& trajectory) {
    for (Claim& claim : claims) claim.is_of_bodies = !moves(trajectory, claim.a) && !moves(trajectory, claim.b);
}

Json name_of(const Model& model, int body) {
    const bool known = body >= 0 && body < static_cast<int>(model.bodies.size());
    return known ? Json(model.bodies[static_cast<size_t>(body)].name) : Json(body);
}

// Clear, violated or undecided, of a pair whose claims are proven.
PairStatus verdict(const Claim& pair, double minimum) {
    if (!pair.is_of_bodies) return PairStatus::undecided;
    if (pair.lower >= minimum && pair.lower > 0 && are_apart(pair.solids)) return PairStatus::clear;
    return pair.upper < minimum ? PairStatus::violated : PairStatus::undecided;
}

PairStatus worst_of(const std::vector<Claim>& claims, double minimum) {
    PairStatus worst = PairStatus::clear;
    for (const Claim& pair : claims) {
        const PairStatus status = verdict(pair, minimum);
        if (status == PairStatus::violated) return status;
        if (status == PairStatus::undecided) worst = status;
    }
    return worst;
}

// What a certificate claims, by name.
Json claims_json(const std::vector<Claim>& claims, const Model& model, const std::optional<double>& minimum) {
    Json list = Json::array();
    for (const Claim& pair : claims) {
        list.push_back({{"a", name_of(model, pair.a)},
                        {"b", name_of(model, pair.b)},
                        {"lower", pair.lower},
                        {"upper", pair.upper},
                        {"solids", to_string(pair.solids)}});
        if (minimum) list.back()["status"] = to_string(verdict(pair, *minimum));
    }
    return list;
}

std::string claim_name(const Claim& pair, const Model& model) {
    const auto name = [](const Json& body) { return body.is_string() ? body.get<std::string>() : body.dump(); };
    return name(name_of(model, pair.a)) + ":" + name(name_of(model, pair.b));
}

std::string claim_text(const Claim& pair, const RoundedLengths& lengths) {
    return "at least " + lengths.fixed(pair.lower, Towards::down) + ", at most " + lengths.fixed(pair.upper, Towards::up) + " " +
           lengths.unit() + "; " + core::clearance::words(pair.solids);
}

std::string claims_text(const Checked& checked, const Model& model, const std::optional<double>& minimum) {
    const RoundedLengths lengths(answers::unit_name(checked.certificate.length_unit));
    std::string text;
    for (const Claim& pair : checked.claims)
        text += "  " + claim_name(pair, model) + "  " + claim_text(pair, lengths) +
                (minimum ? std::string(": ") + to_string(verdict(pair, *minimum)) : "") + "\n";
    return text;
}

const char* const of_path_alone = "of the path as stored, between whose nodes joints may have the bodies elsewhere";

// Against the minimum; without one, what is proven of the two bodies.
Check check_of(const Claim& pair, const std::string& name, const RoundedLengths& lengths, const std::optional<double>& minimum,
               const std::string& file) {
    Check check{name, CheckOutcome::passed, "proven", claim_text(pair, lengths), file};
    if (minimum) {
        const PairStatus status = verdict(pair, *minimum);
        check.rule = to_string(status);
        check.outcome = to_check(status);
        check.message += "; required " + formatted("%.6g ", *minimum / lengths.metres()) + lengths.unit();
    } else if (!pair.is_of_bodies || !are_apart(pair.solids)) {
        check.rule = "undecided";
        check.outcome = CheckOutcome::undecided;
    }
    if (!pair.is_of_bodies) check.message += std::string("; ") + of_path_alone;
    return check;
}

// Are the source's meshes still those of the certificate? Nothing to tell if they are.
struct SourceCheck {
    bool stale = false;
    std::string note;
    bool has_joints = true;  // as far as is known
};

SourceCheck check_source(const Certificate& certificate, const std::string& path, const CommonOptions& common) {
    if (certificate.source.empty()) return {};
    const std::filesystem::path source = clearance::file_of_certificate(path, certificate.source);
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

ExportCheck check_exports(const Certificate& certificate, const std::string& path) {
    ExportCheck check;
    for (const core::certificate::ExportedFile& exported : certificate.exports) {
        const std::filesystem::path file = clearance::file_of_certificate(path, exported.file);
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
    int code = exit_violated;

    void add_fault(const std::string& where, const std::string& message) {
        faults.push_back({{"where", where}, {"message", message}});
        text += "  " + where + ": " + message + "\n";
    }
};

const char* about(const Certificate& certificate) {
    if (certificate.linkage) return "over all positions of the joints";
    if (!certificate.motion) return "as assembled";
    if (certificate.joints) return "over the motion, of joints met at all times";
    return certificate.is_of_path ? "over the motion, of the path as stored" : "over the motion";
}

void check(Checked& checked, const core::records::StoredTrajectory& stored, const CertificateQuestion& question,
           const std::optional<double>& minimum, const CommonOptions& common, Answer& answer) {
    const Certificate& certificate = checked.certificate;
    const core::certificate::CertificateReport& report = checked.report;
    for (const auto& fault : report.faults) answer.add_fault(fault.where, fault.message);
    answer.stale = report.stale;
    const SourceCheck source = check_source(certificate, question.path, common);
    if (source.stale) {
        answer.stale = true;
        answer.add_fault("/source", source.note);
    }
    const bool is_doubtful = certificate.motion && !certificate.joints && !certificate.is_of_path && source.has_joints;
    if (is_doubtful) doubt_bounds(checked.claims, stored.trajectory);
    const ExportCheck exports = check_exports(certificate, question.path);
    for (const std::string& stale : exports.stale) {
        answer.stale = true;
        answer.add_fault("/exports", stale);
    }
    if (!certificate.exports.empty()) answer.json["exports"] = exports.list;
    const bool accepted = answer.faults.empty();
    answer.json["leaves"] = report.leaves;
    answer.json["motion"] = certificate.motion;
    answer.json["pairs"] = claims_json(checked.claims, stored.model, accepted ? minimum : std::nullopt);
    answer.json["uncovered"] = Json::array();
    std::string uncovered;
    for (const auto& [a, b] : uncovered_pairs(certificate, static_cast<int>(stored.model.bodies.size()))) {
        const std::string name = stored.model.bodies[static_cast<size_t>(a)].name + ":" + stored.model.bodies[static_cast<size_t>(b)].name;
        answer.json["uncovered"].push_back(name);
        uncovered += (uncovered.empty() ? "" : ", ") + name;
    }
    answer.json["notes"] = Json::array();
    if (!source.stale && !source.note.empty()) answer.json["notes"].push_back(source.note);
    for (const std::string& note : exports.notes) answer.json["notes"].push_back(note);
    if (is_doubtful)
        answer.json["notes"].push_back(
            "it has no joints, and does not say that the path as stored is all that it is about: of bodies that move nothing is proven "
            "where joints hold them; make it anew");
    if (!accepted) return;
    answer.code = exit_done;
    answer.text += formatted("every claim is proven, in %ld pieces, %s:\n", report.leaves, about(certificate)) +
                   claims_text(checked, stored.model, minimum);
    if (!uncovered.empty()) answer.text += "not covered: " + uncovered + "\n";
    for (const Json& note : answer.json["notes"]) answer.text += "note: " + note.get<std::string>() + "\n";
    if (!minimum) return;
    const PairStatus worst = worst_of(checked.claims, *minimum);
    answer.json["minimum"] = *minimum;
    answer.json["judgement"] = to_string(worst);
    answer.text += "at a minimum of " + question.minimum + ": " + to_string(worst) + "\n";
    answer.code = exit_code(worst);
}

// Of an accepted certificate.
void tell_claims(const Checked& checked, const Model& model, const std::optional<double>& minimum, const std::string& file,
                 Console& console) {
    console.found({file, CheckOutcome::passed, "accepted", "every claim is proven", file});
    const RoundedLengths lengths(answers::unit_name(checked.certificate.length_unit));
    for (const Claim& pair : checked.claims) console.found(check_of(pair, claim_name(pair, model), lengths, minimum, file));
}

void tell_remarks(const Json& json, const std::string& file, Console& console) {
    const auto remark = [&](const std::string& text) { console.found({file, CheckOutcome::remarked, "note", text, file}); };
    for (const Json& note : json.value("notes", Json::array())) remark(note.get<std::string>());
    for (const Json& pair : json.value("uncovered", Json::array())) remark("not covered: " + pair.get<std::string>());
}

}  // namespace

int validate_certificate(const CertificateQuestion& question, const CommonOptions& common, Console& console) {
    const Result<std::optional<double>> minimum = read_minimum(question.minimum);
    if (!minimum) return console.input_errors(minimum.errors());
    const std::string trajectory = question.trajectory.empty() ? clearance::certificate_trajectory(question.path) : question.trajectory;
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
    for (const Json& fault : answer.faults)
        console.found(
            {fault["where"].get<std::string>(), CheckOutcome::failed, status, fault["message"].get<std::string>(), question.path});
    if (accepted) tell_claims(*certificate, stored->model, *minimum, question.path, console);
    tell_remarks(answer.json, question.path, console);
    console.result(answer.json, question.path + ": " + console.coloured(status, accepted) + " for " + trajectory + "\n" + answer.text);
    return answer.code;
}

}  // namespace fettle::design::cli
