// SPDX-License-Identifier: MIT
#include "design/answers/allocation_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "design/answers/tolerance_json.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::answers {

namespace {

using core::base::formatted;
using core::base::percent;
using description::Design;
using description::Tolerance;
using Json = nlohmann::ordered_json;
using studies::AllocatedRequirement;
using studies::AllocatedTolerance;
using studies::AllocationOptions;
using studies::AllocationReport;
using studies::AllocationStatus;
using studies::Response;

description::CountedUnit counted_in(const Design& design, const Response& response) {
    if (response.kind == Response::Kind::constraint) return description::counted_unit(design.constraints[response.index]);
    return {response.bounds.unit};
}

// "+-0.05 mm", "-0.02 to +0.05 mm".
std::string limits_text(const Design& design, const Tolerance& tolerance) {
    const Unit& unit = design.parameters[tolerance.parameter].unit;
    const double one = to_si(1, unit), lower = tolerance.deviation.lower / one, upper = tolerance.deviation.upper / one;
    const std::string name = unit.dimension == Dimension::number ? "" : " " + std::string(unit.name);
    if (std::abs(lower + upper) <= 1e-9 * std::abs(upper)) return formatted("+-%.3g", upper) + name;
    return formatted("%+.3g to %+.3g", lower, upper) + name;
}

class AllocationText {
public:
    AllocationText(const Design& design, const std::vector<Tolerance>& given, const AllocationOptions& options,
                   const AllocationReport& report)
        : design_(design), given_(given), options_(options), report_(report) {}

    std::string all() const {
        const std::string wanted = options_.worst_case ? " every requirement in the worst case"
                                                       : " every requirement with a yield of " + formatted("%.6g%%", 100 * options_.yield);
        std::string text = report_.status == AllocationStatus::not_held      ? "no allocation holds" + wanted
                           : report_.status == AllocationStatus::undecided   ? "undecided"
                           : report_.status == AllocationStatus::interrupted ? "interrupted"
                                                                             : "the loosest tolerances that hold" + wanted;
        if (!report_.message.empty()) text += ": " + report_.message;
        text += "\n";
        for (int j = 0; j < count_of(report_.allocated); ++j) text += line_of(j);
        if (!report_.allocated.empty())
            text += formatted("cost %.4g, as they stood %.4g: %s of it\n", report_.cost, report_.cost_before,
                              percent(report_.cost / report_.cost_before).c_str());
        for (const AllocatedRequirement& requirement : report_.requirements) text += line_of(requirement);
        if (!report_.allocated.empty()) text += "computed, not proven" + checked_by() + "\n";
        return text;
    }

private:
    std::string line_of(int j) const {
        const AllocatedTolerance& a = report_.allocated[j];
        const Tolerance &before = given_[j], &after = report_.tolerances[j];
        std::string what;
        if (before.is_fixed)
            what = "fixed";
        else if (std::abs(a.factor - 1) < 0.02)
            what = "as it is";
        else if (a.factor > 1)
            what = "may be " + formatted("%.3g times as loose", a.factor) + (a.is_widest ? " or more: no requirement limits it" : "");
        else
            what = "must be tightened to " + percent(a.factor);
        if (!a.choice.empty()) what += " (" + a.choice + ")";
        return formatted("  %-40s %-24s -> %-24s %s\n", before.of.c_str(), limits_text(design_, before).c_str(),
                         limits_text(design_, after).c_str(), what.c_str());
    }

    std::string line_of(const AllocatedRequirement& requirement) const {
        const Response& response = report_.study.responses[requirement.response];
        const description::CountedUnit unit = counted_in(design_, response);
        const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 6); };
        std::string text = response.name + ", required " + description::required_text(response.bounds, unit.name) + ": ";
        if (options_.worst_case) {
            text += amount(response.worst.least) + " to " + amount(response.worst.most) + ", linear";
            if (response.least_found)
                text += "; simulated " +
                        (std::isfinite(response.least_found->value) ? amount(response.least_found->value) : "what cannot be simulated") +
                        " to " +
                        (std::isfinite(response.most_found->value) ? amount(response.most_found->value) : "what cannot be simulated");
        } else {
            text += "yield " + formatted("%.4f%%", 100 * requirement.predicted) + " predicted";
            if (!report_.study.samples.empty()) {
                const auto counted = tolerances::counted_yield(response.sampled ? response.sampled->met : 0,
                                                               count_of(report_.study.samples), studies::confidence);
                text += formatted(", %.2f%% sampled (%.2f%% to %.2f%%)", 100 * counted.found.within, 100 * counted.least.within,
                                  100 * counted.most.within);
            }
        }
        return "  " + text + (requirement.is_held ? "" : "; NOT HELD") + (requirement.is_limiting ? "; it limits" : "") + "\n";
    }

    std::string checked_by() const {
        std::string text = "; " + core::base::counted(static_cast<std::size_t>(report_.rounds), "round") + " of models and studies of them";
        if (report_.study.samples.empty() && !options_.worst_case) text += "; --samples N checks it by simulations of made ones";
        if (!report_.study.no_second_order.empty())
            text += "; without a second order, as the design cannot be simulated " + report_.study.no_second_order;
        return text;
    }

    const Design& design_;
    const std::vector<Tolerance>& given_;
    const AllocationOptions& options_;
    const AllocationReport& report_;
};

}  // namespace

Json allocation_json(const Design& design, const std::vector<Tolerance>& given, const AllocationOptions& options,
                     const AllocationReport& report) {
    Json json{{"status", to_string(report.status)}, {"message", report.message}};
    json["yield"] = options.worst_case ? Json() : Json(options.yield);
    json["worst_case"] = options.worst_case;
    json["tolerances"] = Json::array();
    for (int j = 0; j < count_of(report.allocated); ++j) {
        const Unit& unit = design.parameters[given[j].parameter].unit;
        const auto in_unit = [&](double si) { return si / to_si(1, unit); };
        const AllocatedTolerance& a = report.allocated[j];
        json["tolerances"].push_back({{"of", given[j].of},
                                      {"unit", unit.name},
                                      {"lower_before", in_unit(given[j].deviation.lower)},
                                      {"upper_before", in_unit(given[j].deviation.upper)},
                                      {"lower", in_unit(report.tolerances[j].deviation.lower)},
                                      {"upper", in_unit(report.tolerances[j].deviation.upper)},
                                      {"factor", a.factor},
                                      {"fixed", given[j].is_fixed},
                                      {"grade", a.choice.empty() ? Json() : Json(a.choice)},
                                      {"widest", a.is_widest},
                                      {"cost_before", a.cost_before},
                                      {"cost", a.cost}});
    }
    json["cost_before"] = report.cost_before;
    json["cost"] = report.allocated.empty() ? Json() : Json(report.cost);
    json["requirements"] = Json::array();
    for (const AllocatedRequirement& requirement : report.requirements)
        json["requirements"].push_back({{"name", report.study.responses[requirement.response].name},
                                        {"held", requirement.is_held},
                                        {"limiting", requirement.is_limiting},
                                        {"predicted_yield", requirement.predicted}});
    json["rounds"] = report.rounds;
    json["study"] = tolerance_json(design, report.tolerances, report.study);
    return json;
}

std::string allocation_text(const Design& design, const std::vector<Tolerance>& given, const AllocationOptions& options,
                            const AllocationReport& report) {
    return AllocationText(design, given, options, report).all();
}

}  // namespace fettle::design::answers
