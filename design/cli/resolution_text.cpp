// SPDX-License-Identifier: MIT
#include "design/cli/resolution_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/text.hpp"
#include "design/cli/answers.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::cli {

namespace {

using core::base::percent;
using description::Design;
using studies::FinerRun;
using studies::FinerValue;
using studies::is_flip;

constexpr double noticeable = 0.01;  // share that a number changes by
constexpr double least_told = 1e-3;
constexpr std::size_t most_lines = 6;

// Has it to be told? A term of the objective counts for its share of it.
bool is_told(const Design& design, const studies::OptimiseOutcome& outcome, const FinerValue& value) {
    if (is_flip(value)) return true;
    if (!value.of_objective) return value.share > noticeable;
    const description::ObjectiveTerm& term = design.objective[static_cast<size_t>(value.index)];
    return std::abs(term.weight * (value.finer - value.found) / term.unit) > noticeable * std::abs(outcome.final.objective);
}

std::string line_of(const Design& design, const FinerValue& value, const Console& console) {
    const auto k = static_cast<size_t>(value.index);
    double si = 1;
    std::string unit, required;
    if (value.of_objective) {
        const description::ObjectiveTerm& term = design.objective[k];
        si = term.unit;
        unit = core::base::unit_name(term.quantity->dimension(), term.unit);
    } else {
        const description::Constraint& constraint = design.constraints[k];
        si = constraint.bounds.unit;
        unit = description::unit_name(constraint);
        required = ", required " + description::required_text(constraint.bounds, unit);
    }
    std::string text =
        formatted("  %-40s %s %s, as found %s (%s)", value.name.c_str(), description::amount_text(value.finer, si, unit, 5).c_str(),
                  value.run->name.c_str(), description::amount_text(value.found, si, unit, 5).c_str(), percent(value.share).c_str());
    if (value.is_met && !value.is_met_finer) text += required + ": " + console.coloured("NOT MET", false);
    if (!value.is_met && value.is_met_finer) text += required + ": " + console.coloured("met", true);
    return text + "\n";
}

// The run that moves the best objective most.
std::string best_text(const studies::OptimiseOutcome& outcome, const answers::RunFacts& run) {
    const double objective = outcome.final.objective;
    double most = 0;
    const FinerRun* by = nullptr;
    for (const FinerRun& finer : outcome.finer.runs)
        if (const double change = answers::change_of_best(outcome, run, finer); std::abs(change) > std::abs(most)) {
            most = change;
            by = &finer;
        }
    if (by == nullptr || !(std::abs(most) > noticeable * std::abs(objective))) return {};
    return formatted("  the best design would have an objective of about %.4g %s, as found %.4g (%s)\n", objective + most, by->name.c_str(),
                     objective, percent(std::abs(most) / std::max(std::abs(objective), std::abs(objective + most))).c_str());
}

}  // namespace

std::string resolution_text(const Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                            const answers::RunFacts& run) {
    std::vector<std::string> names;
    std::string failures, lines;
    for (const FinerRun& finer : outcome.finer.runs) {
        if (finer.failure.empty())
            names.push_back(finer.name);
        else
            failures += "not simulated " + finer.name + ": " + finer.failure + "\n";
    }
    if (names.empty()) return failures;
    double most = 0;
    std::vector<FinerValue> told;
    for (const FinerValue& value : studies::finer_values(design, outcome.final, outcome.finer)) {
        if (is_told(design, outcome, value)) told.push_back(value);
        if (!value.of_objective) most = std::max(most, value.share);
    }
    std::stable_sort(told.begin(), told.end(),
                     [](const FinerValue& x, const FinerValue& y) { return is_flip(x) != is_flip(y) ? is_flip(x) : x.share > y.share; });
    for (size_t i = 0; i < std::min(told.size(), most_lines); ++i) lines += line_of(design, told[i], console);
    if (told.size() > most_lines)
        lines += "  and " + core::base::counted(told.size() - most_lines, "more number") + " (`resolution` of result.json has all)\n";
    lines += best_text(outcome, run);
    const std::string simulated = names.size() == 1 ? names[0] : names[0] + " or " + names[1];
    if (lines.empty())
        return "resolution: " + simulated + " no requirement's number changes by more than " + percent(std::max(most, least_told)) +
               ", and what is met stays met\n" + failures;
    return "resolution: " + simulated + " these change:\n" + lines +
           "what to do: finer facets (`facets` or `counts` of the shapes), or a shorter `timestep`, and tune again; or require more by the "
           "difference\n" +
           failures;
}

}  // namespace fettle::design::cli
