// SPDX-License-Identifier: MIT
#include "design/answers/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "design/description/requirement_text.hpp"

namespace fettle::design::answers {

using description::Design;
using studies::OptimiseOutcome;

std::string roughest_name(const Design& design, const optimisers::Optimality& o) {
    const auto rough = static_cast<size_t>(std::max(0, o.roughest - 1));
    return o.roughest == 0 || rough >= design.constraints.size() ? "the objective" : design.constraints[rough].name;
}

std::vector<Cost> costs_of(const Design& design, const optimisers::Optimality& o) {
    std::vector<Cost> costs;
    const auto add = [&](size_t row, const std::string& name, const description::Bounds& bounds, const std::string& unit) {
        if (o.step.size() == 0 || !(static_cast<Eigen::Index>(row) < o.multipliers.size())) return;
        const double y = o.multipliers[static_cast<Eigen::Index>(row)] * bounds.unit;
        if (y != 0 && std::abs(y) * 0.01 >= o.worth * 0.1) costs.push_back({name, bounds, unit, y});
    };
    const size_t m = design.constraints.size();
    for (size_t i = 0; i < m; ++i)
        add(i, design.constraints[i].name, design.constraints[i].bounds, description::unit_name(design.constraints[i]));
    for (size_t i = 0; i < design.relations.size(); ++i)
        if (!design.relations[i].by_choices)  // no parameter changes it
            add(m + i, design.relations[i].name, design.relations[i].bounds, description::unit_name(design.relations[i]));
    std::stable_sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return std::abs(a.per_unit) > std::abs(b.per_unit); });
    return costs;
}

double change_of_best(const OptimiseOutcome& outcome, const RunFacts& run, const studies::FinerRun& finer) {
    if (run.repair || outcome.report.status != optimisers::OptimiserStatus::optimal) return std::nan("");
    return studies::change_of_best(outcome.final, outcome.report.optimality.multipliers, finer);
}

std::string why_not_optimal(const Design& design, const OptimiseOutcome& outcome, const RunFacts& run) {
    const optimisers::OptimiserReport& report = outcome.report;
    if (report.status != optimisers::OptimiserStatus::feasible) return {};
    using core::base::formatted;
    const optimisers::Optimality& o = report.optimality;
    const std::string minimised = run.repair ? "the squared change" : "the objective";
    const double size = std::abs(report.best.objective);
    std::vector<std::string> reasons;
    if (report.budget_spent)
        reasons.emplace_back("the budget of evaluations (`max_evaluations`) ended the search");
    else if (!o.judged && o.improvable.empty())
        reasons.push_back(optimisers::words(o));
    if (!o.improvable.empty()) {
        const std::string share = size > 0 ? formatted(", %.2g%% of it", 100 * o.predicted_gain / size) : "";
        reasons.push_back(formatted("a change is still in sight that promises to lower %s by %.3g%s (the tolerance is %.3g)",
                                    minimised.c_str(), o.predicted_gain, share.c_str(), o.worth));
        if (!o.refused.empty()) reasons.back() += ", but designs there cannot be evaluated: " + o.refused;
    }
    if (o.roughest >= 0)
        reasons.push_back(
            formatted("simulated values scatter by up to %.3g in %s (the tolerance is %.3g), most of it by %s, which hides "
                      "whether a better design is near: a wider contact distance (`contact.dhat`) or damping makes the motion "
                      "smoother; where an extreme falls on one step alone (a warning says so), smaller steps do",
                      o.noise_in_objective, minimised.c_str(), o.worth, roughest_name(design, o).c_str()));
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
    return text;
}

}  // namespace fettle::design::answers
