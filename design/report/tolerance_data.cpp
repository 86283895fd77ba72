// SPDX-License-Identifier: MIT
#include "design/report/tolerance_data.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/base/units.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "design/answers/tolerance_json.hpp"
#include "design/description/independent_inputs.hpp"
#include "design/description/requirement_text.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/packed_numbers.hpp"
#include "design/report/report_page.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;
using description::Tolerance;
using studies::Contribution;
using studies::MadeSample;
using studies::Response;
using studies::ToleranceReport;

constexpr int predictions = 8192;  // at samples of the tolerances, whose quantiles are shown
constexpr int quantiles = 512;     // intervals between them
constexpr double group_reach = 3;  // standard deviations of what a group shares, taken as its limits

std::string name_of(const std::string& path) {
    const std::string file = std::filesystem::path(path).filename().string(), ending = ".design.json";
    return file.ends_with(ending) ? file.substr(0, file.size() - ending.size()) : file;
}

std::vector<VectorX> deviations_of_predictions(const std::vector<Tolerance>& tolerances, std::uint64_t seed) {
    std::vector<VectorX> out;
    const description::DeviationSamples samples(tolerances, seed);
    for (int k = 0; k < predictions; ++k) out.push_back(samples.at(k));
    return out;
}

std::vector<double> predicted_quantiles(const Response& response, const std::vector<VectorX>& deviations) {
    if (response.is_rough) return {};
    std::vector<double> all, out;
    for (const VectorX& each : deviations) all.push_back(predicted(response, each));
    std::sort(all.begin(), all.end());
    for (std::size_t k = 0; k <= quantiles; ++k) out.push_back(all[k * (all.size() - 1) / quantiles]);
    return out;
}

double change_by(const Response& response, int tolerance, double deviation) {
    VectorX deviations = VectorX::Zero(response.gradient.size());
    deviations[tolerance] = deviation;
    if (response.is_rough) return response.gradient.dot(deviations);
    return predicted(response, deviations) - response.nominal;
}

Json effect_json(const Response& response, const Contribution& contribution, const std::vector<Tolerance>& tolerances) {
    const bool shared = contribution.tolerance < 0;
    if (shared)
        return {{"at_lower", finite(-group_reach * contribution.sensitivity)},
                {"at_upper", finite(group_reach * contribution.sensitivity)},
                {"shared", true}};
    const tolerances::Distribution& deviation = tolerances[contribution.tolerance].deviation;
    return {{"at_lower", finite(change_by(response, contribution.tolerance, deviation.lower))},
            {"at_upper", finite(change_by(response, contribution.tolerance, deviation.upper))},
            {"shared", false}};
}

// How the contacts of the sample farthest from the prediction differ from those as drawn, where that is far.
Json contacts_of(const Response& response, const ToleranceReport& study) {
    Json texts = Json::array();
    if (!response.sampled || response.sampled->unexplained <= studies::much_unexplained) return texts;
    for (const studies::SwitchedContacts& switched : study.switched) {
        if (switched.sample != response.sampled->farthest_sample) continue;
        for (const gradient_audit::ContactChange& change : switched.changes) texts.push_back(sentence_of(change));
    }
    return texts;
}

Json response_data(const ToleranceReportSource& source, std::size_t index, const std::vector<VectorX>& deviations) {
    const Response& response = source.study.responses[index];
    const description::CountedUnit unit = answers::unit_of(source.file.design, response);
    std::vector<double> values;
    std::vector<std::uint32_t> met;
    for (const MadeSample& sample : source.study.samples) {
        const bool failed = sample.failed();
        values.push_back(failed ? std::numeric_limits<double>::quiet_NaN() : sample.values[static_cast<Eigen::Index>(index)]);
        met.push_back(!failed && sample.met[index] ? 1 : 0);
    }
    Json effects = Json::array();
    for (const Contribution& each : response.contributions) effects.push_back(effect_json(response, each, source.file.tolerances));
    return {{"scale", unit.si},
            {"required", has_bounds(response) ? Json(description::required_text(response.bounds, unit.name)) : Json()},
            {"effects", effects},
            {"predicted", packed(predicted_quantiles(response, deviations))},
            {"values", packed(values)},
            {"met", packed(met)},
            {"contacts", contacts_of(response, source.study)}};
}

// The tolerance that moves a response most; -1: none does.
int moves_most(const Response& response) {
    const auto first = std::find_if(response.contributions.begin(), response.contributions.end(),
                                    [](const Contribution& c) { return c.tolerance >= 0 && c.sensitivity != 0; });
    return first == response.contributions.end() ? -1 : first->tolerance;
}

Json deviations_data(const ToleranceReportSource& source) {
    std::set<int> wanted;
    for (const Response& response : source.study.responses) wanted.insert(moves_most(response));
    Json list = Json::array();
    for (int k = 0; k < count_of(source.file.tolerances); ++k) {
        std::vector<double> all;
        const double one = core::base::to_si(1, source.file.design.parameters[source.file.tolerances[k].parameter].unit);
        for (const MadeSample& sample : source.study.samples) all.push_back(sample.deviations[k] / one);
        list.push_back(wanted.count(k) > 0 && !all.empty() ? packed(all) : Json());
    }
    return list;
}

Json notices_of(const ToleranceReportSource& source) {
    Json texts = Json::array();
    if (source.study.interrupted) texts.push_back("Interrupted: these are the samples that were made by then.");
    if (!source.study.no_second_order.empty())
        texts.push_back("There is no second order, as the design cannot be simulated " + source.study.no_second_order + ".");
    for (const std::string& warning : source.study.warnings) texts.push_back(warning);
    for (const reading::Untoleranced& each : source.file.untoleranced)
        texts.push_back("Without a tolerance: " + each.name + ", " + each.why + ".");
    return texts;
}

}  // namespace

Json tolerance_data(const ToleranceReportSource& source) {
    const std::string description = description_of(source.file.text);
    Json data{{"format", 1}, {"program", core::base::version()}};
    data["command"] = source.command.empty() ? Json() : Json(source.command);
    data["kind"] = "tolerance";
    data["name"] = name_of(source.file.path);
    data["folder"] = source.file.path;
    data["description"] = description.empty() ? Json() : Json(description);
    data["views"] = data["files"] = data["responses"] = Json::array();
    data["notices"] = notices_of(source);
    data["answer"] = answers::tolerance_json(source.file, source.study);
    data["text"] = source.text;
    if (source.study.reason.empty() && !source.study.responses.empty()) {
        const std::vector<VectorX> deviations = deviations_of_predictions(source.file.tolerances, source.study.seed + 1);
        for (std::size_t k = 0; k < source.study.responses.size(); ++k) data["responses"].push_back(response_data(source, k, deviations));
    }
    std::vector<std::uint32_t> numbers;
    for (const MadeSample& sample : source.study.samples) numbers.push_back(static_cast<std::uint32_t>(sample.number));
    data["samples"] = packed(numbers);
    data["deviations"] = deviations_data(source);
    return data;
}

Errors write_tolerance_report(const std::string& file, const ToleranceReportSource& source) {
    return core::files::write_file_atomically(file, page_of(tolerance_data(source)));
}

}  // namespace fettle::design::report
