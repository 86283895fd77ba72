// SPDX-License-Identifier: MIT
#include "design/answers/tolerance_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/text.hpp"
#include "design/answers/answer_json.hpp"

namespace fettle::design::answers {

namespace {

using core::base::formatted;
using core::base::percent;
using description::CountedUnit;
using description::Design;
using description::Tolerance;
using Json = nlohmann::ordered_json;
using studies::confidence;
using studies::Contribution;
using studies::FoundExtreme;
using studies::has_bounds;
using studies::MadeSample;
using studies::Response;
using studies::SampledResponse;
using studies::ToleranceReport;
using tolerances::CapabilityIndex;
using tolerances::CountedYield;
using tolerances::Yield;

const char* word_of(Response::Kind kind) {
    return kind == Response::Kind::objective ? "objective" : kind == Response::Kind::constraint ? "constraint" : "relation";
}

Json yield_json(const Yield& yield) { return {{"within", yield.within}, {"ppm_outside", ppm_outside(yield)}}; }
Json yield_json(const CountedYield& yield) {
    return {{"within", yield.found.within}, {"least", yield.least.within}, {"most", yield.most.within}, {"confidence", confidence}};
}
Json index_json(const std::optional<CapabilityIndex>& index) {
    if (!index) return {};
    return {{"value", index->value}, {"error", index->error}};
}

Json deviations_json(const Design& design, const std::vector<Tolerance>& tolerances, const VectorX& deviations) {
    Json json = Json::object();
    for (int k = 0; k < count_of(tolerances); ++k)
        json[tolerances[k].of] = deviations[k] / to_si(1, design.parameters[tolerances[k].parameter].unit);
    return json;
}

Json found_json(const Design& design, const std::vector<Tolerance>& tolerances, const std::optional<FoundExtreme>& found) {
    if (!found) return {};
    const auto at = [&](const VectorX& deviations) {
        return deviations.size() == 0 ? Json() : deviations_json(design, tolerances, deviations);
    };
    return {{"value", finite_or_null(found->value)},
            {"deviations", at(found->deviations)},
            {"settled", found->settled},
            {"simulations", found->simulations},
            {"failure", found->failure.empty() ? Json() : Json({{"reason", found->failure}, {"deviations", at(found->failed_at)}})}};
}

Json sampled_json(const Response& response, const ToleranceReport& report) {
    if (!response.sampled) return {};
    const SampledResponse& s = *response.sampled;
    const tolerances::Moments& moments = s.moments.moments;
    Json json = {{"mean", moments.mean},
                 {"mean_error", s.moments.mean_error},
                 {"standard_deviation", moments.standard_deviation},
                 {"standard_deviation_error", s.moments.standard_deviation_error},
                 {"skewness", skewness(moments)},
                 {"kurtosis", kurtosis(moments)},
                 {"least", s.least},
                 {"least_sample", s.least_sample},
                 {"most", s.most},
                 {"most_sample", s.most_sample},
                 {"farthest_from_prediction", s.farthest},
                 {"farthest_sample", s.farthest_sample},
                 {"unexplained", s.unexplained}};
    json["controlled_mean"] = nullptr;
    if (s.controlled_mean)
        json["controlled_mean"] = {
            {"value", s.controlled_mean->mean}, {"error", s.controlled_mean->error}, {"correlation", s.controlled_mean->correlation}};
    if (has_bounds(response)) {
        json["met"] = s.met;
        json["yield"] = yield_json(tolerances::counted_yield(s.met, count_of(report.samples), confidence));
        json["controlled_yield"] = s.controlled_yield ? yield_json(*s.controlled_yield) : Json();
        json["cp"] = index_json(s.capability.cp);
        json["cpk"] = index_json(s.capability.cpk);
    }
    return json;
}

Json response_json(const Design& design, const std::vector<Tolerance>& tolerances, const Response& response,
                   const ToleranceReport& report) {
    Json json = {{"name", response.name},
                 {"of", word_of(response.kind)},
                 {"unit", unit_of(design, response).name},
                 {"lower", finite_or_null(response.bounds.lower)},
                 {"upper", finite_or_null(response.bounds.upper)},
                 {"nominal", response.nominal}};
    json["linear"] = {{"mean", response.linear.mean},
                      {"standard_deviation", response.linear.standard_deviation},
                      {"worst_least", response.worst.least},
                      {"worst_most", response.worst.most}};
    json["least_found"] = found_json(design, tolerances, response.least_found);
    json["most_found"] = found_json(design, tolerances, response.most_found);
    if (has_bounds(response)) json["linear"]["yield"] = yield_json(response.linear_yield);
    json["is_rough"] = response.is_rough;
    json["second_order"] = nullptr;
    if (response.second_order) {
        json["second_order"] = {{"mean", response.second_order->mean},
                                {"standard_deviation", response.second_order->standard_deviation},
                                {"skewness", skewness(*response.second_order)},
                                {"kurtosis", kurtosis(*response.second_order)}};
        if (has_bounds(response))
            json["second_order"]["yield"] = response.second_order_yield ? yield_json(*response.second_order_yield) : Json();
    }
    json["sampled"] = sampled_json(response, report);
    json["contributions"] = Json::array();
    for (const Contribution& c : response.contributions)
        json["contributions"].push_back({{"of", c.of}, {"sensitivity", c.sensitivity}, {"share", c.share}, {"worst", c.worst}});
    return json;
}

Json tolerance_json(const Design& design, const Tolerance& tolerance) {
    const Unit& unit = design.parameters[tolerance.parameter].unit;
    const auto in_unit = [&](double si) { return si / to_si(1, unit); };
    const tolerances::Moments moments = moments_of(tolerance.deviation);
    return {{"of", tolerance.of},
            {"stated", tolerance.stated},
            {"unit", unit.name},
            {"lower", in_unit(tolerance.deviation.lower)},
            {"upper", in_unit(tolerance.deviation.upper)},
            {"distribution", to_string(tolerance.deviation.kind)},
            {"mean", in_unit(moments.mean)},
            {"standard_deviation", in_unit(moments.standard_deviation)},
            {"group", tolerance.group.empty() ? Json() : Json(tolerance.group)},
            {"correlation", tolerance.group.empty() ? Json() : Json(tolerance.correlation)}};
}

Json switched_json(const ToleranceReport& report, const studies::SwitchedContacts& switched) {
    Json json = {{"sample", switched.sample}, {"responses", Json::array()}, {"changes", Json::array()}};
    for (const int i : switched.responses) json["responses"].push_back(report.responses[i].name);
    for (const gradient_audit::ContactChange& change : switched.changes)
        json["changes"].push_back({{"event", to_string(change.at.event)},
                                   {"scenario", change.scenario.empty() ? Json() : Json(change.scenario)},
                                   {"body_a", change.body_a},
                                   {"body_b", change.body_b},
                                   {"time", change.time},
                                   {"count", change.count}});
    return json;
}

std::vector<const MadeSample*> failed_of(const ToleranceReport& report) {
    std::vector<const MadeSample*> out;
    for (const MadeSample& sample : report.samples)
        if (sample.failed()) out.push_back(&sample);
    return out;
}

std::string status_of(const ToleranceReport& report) {
    return report.interrupted ? "interrupted" : report.reason.empty() && report.no_second_order.empty() ? "ok" : "undecided";
}
std::string message_of(const ToleranceReport& report) {
    return report.reason.empty() ? report.no_second_order.empty() ? "" : "no second order: " + report.no_second_order : report.reason;
}

// "99.3% (98.1% to 99.8%)".
std::string yield_text(const CountedYield& yield) {
    return formatted("%.4g%% (%.4g%% to %.4g%%)", 100 * yield.found.within, 100 * yield.least.within, 100 * yield.most.within);
}
std::string yield_text(const Yield& yield) { return formatted("%.4g%%", 100 * yield.within); }

class Text {
public:
    // @param process  That was asked for in place of the design's.
    Text(const reading::DesignFile& file, const std::string& process, const ToleranceReport& report)
        : path_(file.path), process_(process), design_(file.design), tolerances_(file.tolerances), report_(report) {}

    std::string all() const {
        std::string text = "tolerances:\n";
        for (const Tolerance& tolerance : tolerances_) text += line_of(tolerance);
        if (!report_.reason.empty()) return text + "undecided: " + report_.reason + "\n";
        for (const Response& response : report_.responses) text += lines_of(response);
        if (!report_.no_second_order.empty())
            text += "undecided: no second order, as the design cannot be simulated " + report_.no_second_order + "\n";
        return text + of_samples() + advice();
    }

private:
    std::string line_of(const Tolerance& tolerance) const {
        const Unit& unit = design_.parameters[tolerance.parameter].unit;
        const double one = to_si(1, unit);
        const auto amount = [&](double si) { return formatted("%+.6g", si / one); };
        const std::string limits =
            amount(tolerance.deviation.lower) + " to " + amount(tolerance.deviation.upper) + " " + std::string(unit.name);
        return formatted("  %-40s %-26s %s, sigma %.4g\n", tolerance.of.c_str(), limits.c_str(), to_string(tolerance.deviation.kind),
                         moments_of(tolerance.deviation).standard_deviation / one);
    }

    std::string lines_of(const Response& response) const {
        const CountedUnit unit = unit_of(design_, response);
        const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 6); };
        const auto spread = [&](double mean, double sigma) { return amount(mean) + ", sigma " + amount(sigma); };
        std::string text = response.name + ": " + amount(response.nominal) + " as drawn";
        if (has_bounds(response)) text += ", required " + description::required_text(response.bounds, unit.name);
        text += "\n";
        const auto row = [&](const char* what, const std::string& value, const std::string& yield) {
            text += formatted("  %-14s %s", what, value.c_str());
            if (has_bounds(response) && !yield.empty()) text += "; yield " + yield;
            text += "\n";
        };
        row("linear", spread(response.linear.mean, response.linear.standard_deviation), yield_text(response.linear_yield));
        if (response.second_order)
            row("second order", spread(response.second_order->mean, response.second_order->standard_deviation),
                response.second_order_yield ? yield_text(*response.second_order_yield) : "not known, far from normal");
        if (response.is_rough)
            row("", "its derivatives change too much within a standard deviation for a prediction, as where a contact begins: take samples",
                "");
        if (response.sampled) {
            const SampledResponse& s = *response.sampled;
            row("sampled", spread(s.moments.moments.mean, s.moments.moments.standard_deviation),
                yield_text(tolerances::counted_yield(s.met, count_of(report_.samples), confidence)));
            if (s.controlled_mean)
                row("",
                    "with the prediction as control: mean " + amount(s.controlled_mean->mean) + " +- " + amount(s.controlled_mean->error),
                    s.controlled_yield ? yield_text(*s.controlled_yield) : "as sampled, which is known better so");
            row("", "from " + amount(s.least) + " to " + amount(s.most) + capability(s), "");
            if (s.unexplained > studies::much_unexplained)
                row("",
                    "predictions miss the samples by " + percent(s.unexplained) + " of their sigma, most (" + amount(s.farthest) +
                        ") in sample " + std::to_string(s.farthest_sample),
                    "");
        }
        row("worst case", amount(response.worst.least) + " to " + amount(response.worst.most) + ", linear", "");
        if (response.least_found && response.most_found) {
            const auto found = [&](const FoundExtreme& extreme) {
                const std::string value =
                    std::isfinite(extreme.value) ? amount(extreme.value) : std::string("nothing that can be simulated");
                return value + (extreme.settled ? "" : " (the search ended early)");
            };
            row("", found(*response.least_found) + " to " + found(*response.most_found) + ", found by simulations", "");
            for (const auto* extreme : {&*response.least_found, &*response.most_found})
                if (!extreme->failure.empty()) {
                    row("", "within the limits there is one that cannot be simulated: " + extreme->failure, "");
                    break;
                }
        }
        return text + "  by " + contributors(response, amount) + "\n";
    }

    static std::string capability(const SampledResponse& s) {
        std::string text;
        if (s.capability.cp) text += formatted("; Cp %.3g +- %.2g", s.capability.cp->value, s.capability.cp->error);
        if (s.capability.cpk) text += formatted("; Cpk %.3g +- %.2g", s.capability.cpk->value, s.capability.cpk->error);
        return text;
    }

    template <class Amount>
    std::string contributors(const Response& response, const Amount& amount) const {
        constexpr int most = 5;
        std::vector<std::string> parts;
        for (const Contribution& c : response.contributions) {
            if (count_of(parts) == most || c.share < 0.001) break;
            parts.push_back(c.tolerance < 0 ? "what " + c.of + " shares " + percent(c.share)
                                            : c.of + " " + percent(c.share) + " (+-" + amount(c.worst) + ")");
        }
        return parts.empty() ? "nothing: no tolerance changes it" : core::base::joined(parts);
    }

    std::string of_samples() const {
        constexpr std::size_t most_told = 5;
        if (report_.samples.empty()) return report_.interrupted ? "interrupted\n" : "";
        std::string text = core::base::counted(report_.samples.size(), "sample") + ": " + std::to_string(report_.met_all) +
                           " meet every requirement, " +
                           yield_text(tolerances::counted_yield(report_.met_all, count_of(report_.samples), confidence)) +
                           formatted(" at %.0f%% confidence\n", 100 * confidence);
        if (report_.controlled_yield) text += "  with the predictions as control: " + yield_text(*report_.controlled_yield) + "\n";
        const std::vector<const MadeSample*> failed = failed_of(report_);
        if (!failed.empty())
            text += core::base::counted(failed.size(), "sample") + " could not be made or simulated, and count as misses:\n";
        const std::vector<studies::FailureKind> kinds = studies::kinds_of_failure(report_);
        for (std::size_t k = 0; k < std::min(kinds.size(), most_told); ++k)
            text += "  sample " + std::to_string(kinds[k].first) + ": " + kinds[k].reason +
                    (kinds[k].count > 1 ? formatted(" (%d so)", kinds[k].count) : "") + "\n    " + to_see(kinds[k].first);
        if (kinds.size() > most_told) text += formatted("  and %zu kinds more\n", kinds.size() - most_told);
        if (const auto worst = studies::worst_sample(report_))
            text += "sample " + std::to_string(worst->sample) + " is the one " +
                    (worst->is_beyond ? "farthest beyond what is required, of " : "nearest to a bound, that of ") +
                    report_.responses[worst->response].name + "\n  " + to_see(worst->sample);
        for (const studies::SwitchedContacts& switched : report_.switched) text += of_contacts(switched);
        return report_.interrupted ? text + "interrupted\n" : text;
    }

    // The command that simulates one of the samples.
    std::string to_see(int sample) const {
        return "to see it: fettle simulate " + shell_word(path_) + formatted(" --made %d", sample) +
               (report_.seed == 1 ? "" : formatted(" --seed %llu", static_cast<unsigned long long>(report_.seed))) +
               (process_.empty() ? "" : " --process " + shell_word(process_)) + " --out FOLDER\n";
    }

    std::string of_contacts(const studies::SwitchedContacts& switched) const {
        constexpr std::size_t most_told = 5;
        std::vector<std::string> names;
        for (const int i : switched.responses) names.push_back(report_.responses[i].name);
        std::string text =
            "sample " + std::to_string(switched.sample) + ", the farthest from the prediction of " + core::base::joined(names);
        if (switched.changes.empty()) return text + ", has the contacts of the design as drawn\n";
        text += ", has other contacts than the design as drawn:\n";
        for (std::size_t k = 0; k < std::min(switched.changes.size(), most_told); ++k)
            text += "  " + sentence_of(switched.changes[k]) + "\n";
        if (switched.changes.size() > most_told) text += formatted("  and %zu more\n", switched.changes.size() - most_told);
        return text;
    }

    std::string advice() const {
        std::string text;
        for (const studies::Tightening& t : studies::what_to_tighten(report_)) {
            const Response& response = report_.responses[t.response];
            const CountedUnit unit = unit_of(design_, response);
            const auto amount = [&](double si) { return description::amount_text(si, unit.si, unit.name, 3); };
            const double sigma = response.linear.standard_deviation;
            std::vector<std::string> ways;
            if (response.bounds.upper - response.bounds.lower > 6 * sigma)
                ways.push_back("move its mean by " + amount(3 * (sigma - t.needed)) + " away from the bound");
            if (t.needed > 0)
                ways.push_back("tighten " + (t.tolerance ? tolerances_[*t.tolerance].of : "all that it depends on") + " to " +
                               percent(t.factor) + " (sigma " + amount(t.needed) + ")");
            text += "  " + response.name + ": for Cpk 1 ";
            text += ways.empty() ? "move its mean within the bounds, and tighten: they are less than 6 sigma apart" : ways.front();
            if (ways.size() == 2) text += ", or " + ways.back();
            text += "\n";
        }
        for (const int k : studies::what_may_be_loosened(report_, tolerances_))
            text += "  " + tolerances_[k].of + " may be twice as wide: no requirement notices\n";
        return text.empty() ? text : "what to do:\n" + text;
    }

    const std::string &path_, &process_;
    const Design& design_;
    const std::vector<Tolerance>& tolerances_;
    const ToleranceReport& report_;
};

}  // namespace

CountedUnit unit_of(const Design& design, const Response& response) {
    if (response.kind == Response::Kind::constraint) return description::counted_unit(design.constraints[response.index]);
    if (response.kind == Response::Kind::relation) return {response.bounds.unit, description::unit_name(design.relations[response.index])};
    return {response.bounds.unit};
}

Json tolerance_json(const Design& design, const std::vector<Tolerance>& tolerances, const ToleranceReport& report) {
    Json json = {{"status", status_of(report)}, {"message", message_of(report)}};
    if (!report.warnings.empty()) json["warnings"] = report.warnings;
    json["tolerances"] = Json::array();
    for (const Tolerance& tolerance : tolerances) json["tolerances"].push_back(tolerance_json(design, tolerance));
    json["responses"] = Json::array();
    if (report.reason.empty())
        for (const Response& response : report.responses) json["responses"].push_back(response_json(design, tolerances, response, report));
    const std::vector<const MadeSample*> failed = failed_of(report);
    const int samples = count_of(report.samples);
    json["samples"] = {{"count", samples}, {"seed", report.seed}, {"met", report.met_all}, {"failed", failed.size()}};
    json["samples"]["yield"] = samples > 0 ? yield_json(tolerances::counted_yield(report.met_all, samples, confidence)) : Json();
    json["samples"]["controlled_yield"] = report.controlled_yield ? yield_json(*report.controlled_yield) : Json();
    json["tighten"] = Json::array();
    for (const studies::Tightening& t : studies::what_to_tighten(report))
        json["tighten"].push_back({{"name", report.responses[t.response].name},
                                   {"standard_deviation", t.needed},
                                   {"of", t.tolerance ? Json(tolerances[*t.tolerance].of) : Json()},
                                   {"factor", t.factor}});
    json["loosen"] = Json::array();
    for (const int k : studies::what_may_be_loosened(report, tolerances)) json["loosen"].push_back(tolerances[k].of);
    json["worst_sample"] = nullptr;
    if (const auto worst = studies::worst_sample(report))
        json["worst_sample"] = {{"sample", worst->sample}, {"of", report.responses[worst->response].name}, {"beyond", worst->is_beyond}};
    json["kinds_of_failure"] = Json::array();
    for (const studies::FailureKind& kind : studies::kinds_of_failure(report))
        json["kinds_of_failure"].push_back({{"sample", kind.first}, {"count", kind.count}, {"reason", kind.reason}});
    json["failed"] = Json::array();
    for (const MadeSample* sample : failed)
        json["failed"].push_back({{"sample", sample->number},
                                  {"reason", sample->reason},
                                  {"deviations", deviations_json(design, tolerances, sample->deviations)}});
    json["switched_contacts"] = Json::array();
    for (const studies::SwitchedContacts& switched : report.switched) json["switched_contacts"].push_back(switched_json(report, switched));
    return json;
}

Json tolerance_json(const reading::DesignFile& file, const ToleranceReport& report) {
    Json json = tolerance_json(file.design, file.tolerances, report);
    json["process"] = file.process.empty() ? Json() : Json(file.process);
    json["untoleranced"] = Json::array();
    for (const reading::Untoleranced& each : file.untoleranced) json["untoleranced"].push_back({{"name", each.name}, {"why", each.why}});
    return json;
}

std::string tolerance_text(const reading::DesignFile& file, const ToleranceReport& report, const std::string& process) {
    std::string text = Text(file, process, report).all();
    if (!file.untoleranced.empty()) text += "without a tolerance (\"*\" leaves them out):\n";
    for (const reading::Untoleranced& each : file.untoleranced) text += "  " + each.name + ": " + each.why + "\n";
    return text;
}

}  // namespace fettle::design::answers
