// SPDX-License-Identifier: MIT
#include "fettle/design/cli/validate_certificate.hpp"

#include <nlohmann/json.hpp>

#include "fettle/core/base/units.hpp"
#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/cli/answers.hpp"
#include "fettle/design/cli/certificate_files.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

// What a certificate claims, by name.
Json claims_json(const core::certificate::Certificate& certificate, const core::model::Model& model) {
    const auto name = [&](int body) {
        const bool known = body >= 0 && body < static_cast<int>(model.bodies.size());
        return known ? Json(model.bodies[static_cast<size_t>(body)].name) : Json(body);
    };
    Json list = Json::array();
    for (const auto& pair : certificate.pairs)
        list.push_back({{"a", name(pair.a)}, {"b", name(pair.b)}, {"lower", pair.lower}, {"upper", pair.upper}});
    return list;
}

std::string claims_text(const Json& claims, const core::model::Model& model) {
    const std::string unit = unit_name(model.length_unit);
    const double factor = 1 / core::base::metres_per_unit(unit).value();
    std::string text;
    const auto name = [](const Json& body) { return body.is_string() ? body.get<std::string>() : body.dump(); };
    for (const Json& pair : claims)
        text += formatted("  %s:%s  at least %.9g, at most %.9g %s\n", name(pair["a"]).c_str(), name(pair["b"]).c_str(),
                          pair["lower"].get<double>() * factor, pair["upper"].get<double>() * factor, unit.c_str());
    return text;
}

}  // namespace

int validate_certificate(const CertificateQuestion& question, Console& console) {
    const std::string trajectory = question.trajectory.empty() ? certificate_trajectory(question.path) : question.trajectory;
    const auto stored = core::records::read_trajectory(trajectory);
    if (!stored) return console.input_errors(stored.errors());
    Json json{{"status", "rejected"}, {"kind", "certificate"}, {"trajectory", trajectory}};
    Json faults = Json::array();
    std::string text;
    const auto certificate = core::certificate::read_certificate(question.path);
    for (const Error& error : certificate.errors()) faults.push_back({{"where", error.where}, {"message", error.message}});
    if (certificate) {
        const core::certificate::CertificateReport report = core::certificate::check_certificate(*certificate, *stored);
        for (const auto& fault : report.faults) faults.push_back({{"where", fault.where}, {"message", fault.message}});
        if (report.accepted()) json["status"] = "accepted";
        json["leaves"] = report.leaves;
        json["motion"] = certificate->motion;
        json["pairs"] = claims_json(*certificate, stored->model);
        if (report.accepted()) {
            text = formatted("every claim is proven, in %ld pieces, %s:\n", report.leaves,
                             certificate->motion ? "over the motion" : "as assembled") +
                   claims_text(json["pairs"], stored->model);
        }
    }
    json["faults"] = faults;
    for (const Json& fault : faults) text += "  " + fault["where"].get<std::string>() + ": " + fault["message"].get<std::string>() + "\n";
    const bool accepted = faults.empty();
    console.result(
        json, question.path + ": " + console.coloured(json["status"].get<std::string>(), accepted) + " for " + trajectory + "\n" + text);
    return accepted ? exit_done : exit_violated;
}

}  // namespace fettle::design::cli
