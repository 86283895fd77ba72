// SPDX-License-Identifier: MIT
#include "design/cli/validate_certificate.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/rounded_lengths.hpp"
#include "core/base/units.hpp"
#include "core/clearance/clearance.hpp"
#include "core/files/json_dump.hpp"
#include "core/records/trajectory_io.hpp"
#include "design/answers/answer_json.hpp"
#include "design/clearance/certificate_claims.hpp"
#include "design/clearance/certificate_files.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/certificate_domain.hpp"
#include "design/cli/inputs.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;
using clearance::CertificateStatus;
using clearance::CheckedCertificate;
using clearance::Claim;
using clearance::ExportStatus;
using core::base::RoundedLengths;
using core::base::Towards;
using core::clearance::PairStatus;
using core::model::Model;
using core::records::StoredTrajectory;

Json name_of(const Model& model, int body) {
    const bool known = body >= 0 && body < count_of(model.bodies);
    return known ? Json(model.bodies[body].name) : Json(body);
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
        const std::optional<double> required = clearance::minimum_of(pair, minimum);
        if (!required) continue;
        list.back()["minimum"] = *required;
        list.back()["status"] = to_string(verdict(pair, *required));
    }
    return list;
}

std::string claim_name(const Claim& pair, const Model& model) {
    const auto name = [](const Json& body) { return body.is_string() ? body.get<std::string>() : core::files::dumped(body); };
    return name(name_of(model, pair.a)) + ":" + name(name_of(model, pair.b));
}

std::string claim_text(const Claim& pair, const RoundedLengths& lengths) {
    return "at least " + lengths.fixed(pair.lower, Towards::down) + ", at most " + lengths.fixed(pair.upper, Towards::up) + " " +
           lengths.unit() + "; " + core::clearance::words(pair.solids);
}

std::string required_text(double minimum, const RoundedLengths& lengths) {
    return formatted("%.6g ", minimum / lengths.metres()) + lengths.unit();
}

std::string claims_text(const CheckedCertificate& checked, const Model& model, const std::optional<double>& minimum) {
    const RoundedLengths lengths(answers::unit_name(checked.certificate->length_unit));
    std::string text;
    for (const Claim& pair : checked.claims) {
        text += "  " + claim_name(pair, model) + "  " + claim_text(pair, lengths);
        const std::optional<double> required = clearance::minimum_of(pair, minimum);
        if (required && !minimum) text += "; required " + required_text(*required, lengths);
        if (required) text += std::string(": ") + to_string(verdict(pair, *required));
        text += "\n";
    }
    return text;
}

// Against the minimum; without one, what is proven of the two bodies.
Check check_of(const Claim& pair, const std::string& name, const RoundedLengths& lengths, const std::optional<double>& minimum,
               const std::string& file) {
    Check check{name, CheckOutcome::passed, "proven", claim_text(pair, lengths), file};
    if (const std::optional<double> required = clearance::minimum_of(pair, minimum)) {
        const PairStatus status = verdict(pair, *required);
        check.rule = to_string(status);
        check.outcome = to_check(status);
        check.message += "; required " + required_text(*required, lengths);
    } else if (!pair.doubt.empty() || !are_apart(pair.solids)) {
        check.rule = "undecided";
        check.outcome = CheckOutcome::undecided;
    }
    if (!pair.doubt.empty()) check.message += "; " + pair.doubt;
    return check;
}

Result<std::optional<double>> read_minimum(const std::string& text) {
    if (text.empty()) return std::optional<double>{};
    const Result<double> length = core::base::parse_length(text, "--minimum");
    if (!length) return length.errors();
    if (*length < 0) return Error{ErrorCode::out_of_range, "--minimum", "a clearance is not negative"};
    return std::optional<double>(*length);
}

std::string name_of_pair(const std::array<int, 2>& pair, const Model& model) { return claim_name({pair[0], pair[1]}, model); }

const char* word(ExportStatus status) {
    return status == ExportStatus::same ? "same" : status == ExportStatus::changed ? "changed" : "not there";
}

Json checked_json(const CheckedCertificate& checked, const StoredTrajectory& stored, const std::optional<double>& minimum) {
    const Model& model = stored.model;
    Json json = Json::object();
    if (!checked.certificate) return json;
    json["source"] = checked.source.empty() ? Json() : Json(checked.source);
    json["domain"] = domain_json(*checked.certificate, stored.trajectory);
    if (!checked.exports.empty()) json["exports"] = Json::array();
    for (const auto& exported : checked.exports)
        json["exports"].push_back({{"file", exported.file}, {"status", word(exported.status)}, {"rounding", exported.rounding}});
    json["leaves"] = checked.leaves;
    json["motion"] = checked.certificate->motion;
    json["pairs"] = claims_json(checked.claims, model, minimum);
    json["uncovered"] = Json::array();
    for (const auto& pair : checked.uncovered) json["uncovered"].push_back(name_of_pair(pair, model));
    json["notes"] = checked.notes;
    return json;
}

// The text about an accepted certificate.
std::string accepted_text(const CheckedCertificate& checked, const Model& model, const std::optional<double>& minimum) {
    std::string text = formatted("every claim is proven, in %ld pieces, %s:\n", checked.leaves, domain_name(*checked.certificate)) +
                       claims_text(checked, model, minimum);
    std::vector<std::string> uncovered;
    for (const auto& pair : checked.uncovered) uncovered.push_back(name_of_pair(pair, model));
    if (!uncovered.empty()) text += "not covered: " + core::base::joined(uncovered) + "\n";
    for (const std::string& note : checked.notes) text += "note: " + note + "\n";
    return text;
}

void tell_checks(const CheckedCertificate& checked, const Model& model, const std::optional<double>& minimum, const std::string& file,
                 Console& console) {
    for (const auto& fault : checked.faults)
        console.found({fault.where, CheckOutcome::failed, to_string(checked.status), fault.message, file});
    if (checked.status == CertificateStatus::accepted) {
        console.found({file, CheckOutcome::passed, "accepted", "every claim is proven", file});
        const RoundedLengths lengths(answers::unit_name(checked.certificate->length_unit));
        for (const Claim& claim : checked.claims) console.found(check_of(claim, claim_name(claim, model), lengths, minimum, file));
    }
    const auto remark = [&](const std::string& text) { console.found({file, CheckOutcome::remarked, "note", text, file}); };
    for (const std::string& note : checked.notes) remark(note);
    for (const auto& pair : checked.uncovered) remark("not covered: " + name_of_pair(pair, model));
}

}  // namespace

int validate_certificate(const CertificateQuestion& question, const CommonOptions& common, Console& console) {
    const Result<std::optional<double>> minimum = read_minimum(question.minimum);
    if (!minimum) return console.input_errors(minimum.errors());
    if (!question.source.empty() && !std::filesystem::exists(question.source))
        return console.input_errors({{ErrorCode::file_not_found, question.source, "no such file"}});
    const std::string trajectory = question.trajectory.empty() ? clearance::certificate_trajectory(question.path) : question.trajectory;
    const auto stored = core::records::read_trajectory(trajectory);
    if (!stored) return console.input_errors(stored.errors());
    CheckedCertificate checked = clearance::check_certificate_file(question.path, *stored, input_options(common), question.source);
    const bool accepted = checked.status == CertificateStatus::accepted;
    if (!accepted)
        for (Claim& claim : checked.claims) claim.minimum.reset();  // bounds that are not proven are not judged
    const std::optional<double> asked = accepted ? *minimum : std::nullopt;
    Json json{{"status", to_string(checked.status)}, {"kind", "certificate"}, {"trajectory", trajectory}};
    json.update(checked_json(checked, *stored, asked));
    std::string text = question.path + ": " + console.coloured(to_string(checked.status), accepted) + " for " + trajectory + "\n";
    for (const auto& fault : checked.faults) text += "  " + fault.where + ": " + fault.message + "\n";
    if (checked.certificate)
        text += domain_text(*checked.certificate, stored->trajectory, RoundedLengths(answers::unit_name(checked.certificate->length_unit)));
    if (accepted) text += accepted_text(checked, stored->model, asked);
    int code = accepted ? exit_done : exit_violated;
    if (const auto worst = worst_of(checked.claims, asked)) {
        if (asked) json["minimum"] = *asked;
        json["judgement"] = to_string(*worst);
        text += (asked ? "at a minimum of " + question.minimum : "at the minima that it states") + ": " + to_string(*worst) + "\n";
        code = exit_code(*worst);
    }
    json["faults"] = Json::array();
    for (const auto& fault : checked.faults) json["faults"].push_back({{"where", fault.where}, {"message", fault.message}});
    tell_checks(checked, stored->model, asked, question.path, console);
    console.result(json, text);
    return code;
}

}  // namespace fettle::design::cli
