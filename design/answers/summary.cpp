// SPDX-License-Identifier: MIT
#include "design/answers/summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/base/text.hpp"
#include "design/description/requirement_text.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/in_scenario.hpp"

namespace fettle::design::answers {

namespace {

using core::base::counted;
using core::base::formatted;
using description::Bounds;
using description::Design;
using description::Measurement;
using optimisers::OptimiserStatus;
using studies::JudgedDesign;
using studies::OptimiseOutcome;
using Verdict = SummaryRow::Verdict;

constexpr int fewest_digits = 4, most_digits = 10;

// By as many digits as keep it on its side of both bounds.
std::string short_text(double si, const Bounds& bounds) {
    std::string text;
    for (int digits = fewest_digits; digits <= most_digits; ++digits) {
        text = formatted("%.*g", digits, si / bounds.unit);
        const double shown = std::strtod(text.c_str(), nullptr) * bounds.unit;
        if ((si < bounds.lower) == (shown < bounds.lower) && (si > bounds.upper) == (shown > bounds.upper)) break;
    }
    return text;
}

// The end of its range that is nearer to what is required.
double judged_by(const Measurement& measured, const Bounds& bounds) {
    return bounds.upper - measured.upper < measured.lower - bounds.lower ? measured.upper : measured.lower;
}

const char* wish(double weight) { return weight < 0 ? "as much as possible" : "as little as possible"; }

class SummaryMaker {
public:
    /// @param costs, start  Of the search that found the design; empty: there was none.
    SummaryMaker(const Design& design, const JudgedDesign& judged, std::vector<Cost> costs, studies::MeasuredAtStart start)
        : design_(design), judged_(judged), costs_(std::move(costs)), start_(std::move(start)) {}

    std::vector<SummaryRow> rows() const {
        std::vector<SummaryRow> out;
        for (std::size_t i = 0; i < judged_.final.constraints.size(); ++i) out.push_back(of_constraint(i));
        for (Eigen::Index i = 0; i < judged_.final.relations.values.size(); ++i) out.push_back(of_relation(i));
        for (std::size_t k = 0; k < judged_.final.terms.size(); ++k) out.push_back(of_term(k));
        return out;
    }

private:
    bool holds(const std::string& requirement) const {
        return std::any_of(costs_.begin(), costs_.end(), [&](const Cost& cost) { return cost.requirement == requirement; });
    }

    SummaryRow of_constraint(std::size_t i) const {
        const auto& [name, bounds, quantity] = design_.constraints[i];
        const Measurement& measured = judged_.final.constraints[i];
        SummaryRow row;
        row.name = name;
        row.unit = description::unit_name(design_.constraints[i]);
        if (i < start_.constraints.size()) {
            const double before = start_.constraints[i];
            row.before = short_text(before, bounds);
            row.was_missed = description::violation(bounds, description::computed(before)) > 0;
        }
        row.now = measured.fault.empty() ? short_text(judged_by(measured, bounds), bounds) : "-";
        row.asked = description::required_text(bounds, row.unit);
        row.known = !measured.is_proven                                                            ? SummaryRow::Known::computed
                    : less_when_round(design_.constraints[i], measured, judged_.final).has_value() ? SummaryRow::Known::of_facets
                                                                                                   : SummaryRow::Known::proven;
        const bool doubtful = std::count(judged_.in_doubt.begin(), judged_.in_doubt.end(), i) > 0;
        row.verdict = !(description::violation(bounds, measured) <= 0) ? Verdict::violated : doubtful ? Verdict::in_doubt : Verdict::met;
        row.holds = holds(name);
        return row;
    }

    SummaryRow of_relation(Eigen::Index i) const {
        const description::Relation& relation = design_.relations[static_cast<std::size_t>(i)];
        const double value = judged_.final.relations.values[i];
        SummaryRow row;
        row.name = relation.name;
        row.unit = description::unit_name(relation);
        row.now = short_text(value, relation.bounds);
        row.asked = description::required_text(relation.bounds, row.unit);
        row.verdict = description::violation(relation, value) <= 0 ? Verdict::met : Verdict::violated;
        row.holds = holds(relation.name);
        return row;
    }

    SummaryRow of_term(std::size_t k) const {
        const description::ObjectiveTerm& term = design_.objective[k];
        Bounds open;
        open.unit = term.unit;
        SummaryRow row;
        row.name = term.name;
        row.unit = core::base::unit_name(term.quantity->dimension(), term.unit);
        if (k < start_.terms.size()) row.before = short_text(start_.terms[k], open);
        row.now = short_text(judged_.final.terms[k].value, open);
        row.asked = wish(term.weight);
        row.verdict = Verdict::wanted;
        return row;
    }

    const Design& design_;
    const JudgedDesign& judged_;
    std::vector<Cost> costs_;
    studies::MeasuredAtStart start_;
};

std::size_t count_of_verdict(const std::vector<SummaryRow>& rows, Verdict verdict) {
    return static_cast<std::size_t>(
        std::count_if(rows.begin(), rows.end(), [verdict](const SummaryRow& row) { return row.verdict == verdict; }));
}

std::string requirements_text(const std::vector<SummaryRow>& rows) {
    const std::size_t wanted = count_of_verdict(rows, Verdict::wanted), all = rows.size() - wanted,
                      violated = count_of_verdict(rows, Verdict::violated);
    if (all == 0) return "nothing is required";
    if (violated == 0) return "every requirement is met";
    return std::to_string(violated) + " of " + counted(all, "requirement") + (violated == 1 ? " is" : " are") + " not met";
}

std::string capital(std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string sentence_of(const OptimiseOutcome& outcome, const std::vector<SummaryRow>& rows, const RunFacts& run, bool is_doubtful) {
    const optimisers::OptimiserReport& report = outcome.report;
    const std::string tried = " (" + counted(static_cast<std::size_t>(report.evaluations), "design") + " tried)";
    const std::string requirements = requirements_text(rows) + tried + ".";
    switch (report.status) {
        case OptimiserStatus::optimal:
            if (is_doubtful) return "As simulated " + requirements;
            return "Done: " + requirements + (run.repair ? " No smaller change near by does it." : " No better design near by.");
        case OptimiserStatus::interrupted:
            return "Stopped on request: " + requirements;
        default:
            return capital(requirements);
    }
}

std::string doubt_text(const JudgedDesign& judged) {
    if (judged.in_doubt.empty()) return {};
    return "in doubt: with the play of the fits taken up " + counted(judged.in_doubt.size(), "requirement") +
           (judged.in_doubt.size() == 1 ? " is" : " are") + " not met";
}

// What is met by the facets and time steps of the design alone.
std::string resolution_doubt(const Design& design, const JudgedDesign& judged) {
    std::vector<std::string> names;
    std::string run;
    for (const studies::FinerValue& value : studies::finer_values(design, judged.final, judged.finer)) {
        if (!studies::is_flip(value) || !value.is_met) continue;
        if (names.empty()) run = value.run->name;
        names.push_back(value.name);
    }
    if (names.empty()) return {};
    return "rests on facets or time steps: " + run + " " + names.front() + " is not met" +
           (names.size() > 1 ? ", nor " + counted(names.size() - 1, "other") : "");
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() || line.empty() ? "" : "; ") + line;
    return text;
}

}  // namespace

Summary summary_of(const Design& design, const OptimiseOutcome& outcome, const RunFacts& run) {
    const optimisers::OptimiserReport& report = outcome.report;
    Summary summary;
    if (!report.best.usable) {
        summary.sentence = "No design could be evaluated (" + counted(static_cast<std::size_t>(report.evaluations), "design") + " tried).";
        summary.why = report.message;
        return summary;
    }
    summary.rows = SummaryMaker(design, outcome, costs_of(design, report.optimality), outcome.measured_at_start).rows();
    std::string not_optimal = why_not_optimal(design, outcome, run);
    if (!not_optimal.empty()) not_optimal = "not shown to be the best: " + not_optimal;
    const bool has_failed = report.status == OptimiserStatus::infeasible;
    const std::string doubts = joined({doubt_text(outcome), resolution_doubt(design, outcome)});
    summary.sentence = sentence_of(outcome, summary.rows, run, !doubts.empty());
    summary.why = joined({has_failed ? report.message : "", not_optimal, doubts});
    summary.is_good = report.status == OptimiserStatus::optimal && summary.why.empty();
    return summary;
}

Summary summary_of(const Design& design, const JudgedDesign& judged) {
    Summary summary;
    summary.rows = SummaryMaker(design, judged, {}, {}).rows();
    if (!judged.final.usable) {
        summary.sentence = "The design cannot be evaluated.";
        summary.why = judged.final.reason;
        return summary;
    }
    summary.why = joined({doubt_text(judged), resolution_doubt(design, judged)});
    const std::string requirements = requirements_text(summary.rows) + ".";
    summary.sentence = summary.why.empty() ? capital(requirements) : "As simulated " + requirements;
    summary.is_good = summary.why.empty() && count_of_verdict(summary.rows, Verdict::violated) == 0;
    return summary;
}

std::optional<core::clearance::TrueBounds> less_when_round(const description::Constraint& constraint, const Measurement& measured,
                                                           const problem::DesignEvaluation& final) {
    const Bounds& bounds = constraint.bounds;
    const bool is_clearance = quantities::clearance_of(*constraint.quantity) != nullptr;
    if (!is_clearance || !measured.clearance || bounds.over_tolerances || final.runs.empty() || !final.runs.front().model ||
        description::violation(bounds, measured) > 0)
        return std::nullopt;
    const auto round = core::clearance::true_bounds(*final.runs.front().model, *measured.clearance);
    if (!round || (round->lower >= bounds.lower && round->lower_is_proven)) return std::nullopt;
    return round;
}

const char* words(SummaryRow::Known known) {
    constexpr const char* all[] = {"computed", "proven", "proven for the facets"};
    return all[static_cast<int>(known)];
}

std::vector<SummaryRow> chosen_rows(const std::vector<SummaryRow>& rows, std::size_t most) {
    const auto rank = [](const SummaryRow& row) {
        if (row.verdict == Verdict::violated) return 0;
        if (row.verdict == Verdict::in_doubt) return 1;
        if (row.verdict == Verdict::wanted) return 3;
        return row.holds || row.was_missed ? 2 : 4;
    };
    std::vector<std::size_t> order(rows.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(rows[a]) < rank(rows[b]); });
    order.resize(std::min(most, order.size()));
    std::sort(order.begin(), order.end());
    std::vector<SummaryRow> out;
    for (const std::size_t i : order) out.push_back(rows[i]);
    return out;
}

nlohmann::ordered_json summary_json(const Summary& summary) {
    using Json = nlohmann::ordered_json;
    constexpr const char* verdicts[] = {"met", "violated", "in doubt", "wanted"};
    Json rows = Json::array();
    for (const SummaryRow& row : summary.rows)
        rows.push_back({{"name", row.name},
                        {"before", row.before.empty() ? Json() : Json(row.before)},
                        {"now", row.now},
                        {"unit", row.unit},
                        {"asked", row.asked},
                        {"known", words(row.known)},
                        {"verdict", verdicts[static_cast<int>(row.verdict)]},
                        {"holds", row.holds}});
    return {{"sentence", summary.sentence}, {"why", summary.why.empty() ? Json() : Json(summary.why)}, {"rows", rows}};
}

}  // namespace fettle::design::answers
