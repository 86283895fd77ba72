// SPDX-License-Identifier: MIT
#include "fettle/design/answers/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "fettle/core/base/text.hpp"

namespace fettle::design::answers {

using description::Design;
using studies::OptimiseOutcome;

std::string roughest_name(const Design& design, const optimisers::Optimality& o) {
    const auto rough = static_cast<size_t>(std::max(0, o.roughest - 1));
    return o.roughest == 0 || rough >= design.constraints.size() ? "the objective" : design.constraints[rough].name;
}

std::vector<Cost> costs_of(const Design& design, const optimisers::Optimality& o) {
    std::vector<Cost> costs;
    for (size_t i = 0; i < design.constraints.size() && o.step.size() > 0; ++i) {
        const double y = o.multipliers[i] * design.constraints[i].bounds.unit;
        if (y != 0 && std::abs(y) * 0.01 >= o.worth * 0.1) costs.push_back({i, design.constraints[i].name, y});
    }
    std::stable_sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return std::abs(a.per_unit) > std::abs(b.per_unit); });
    return costs;
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
