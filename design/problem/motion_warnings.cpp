// SPDX-License-Identifier: MIT
#include "design/problem/motion_warnings.hpp"

#include "core/stepper/balance.hpp"
#include "core/stepper/branch_warnings.hpp"
#include "design/problem/doubtful_extremes.hpp"

namespace fettle::design::problem {

std::vector<std::string> motion_warnings(const description::Design& design, const DesignEvaluation& evaluation) {
    std::vector<std::string> out;
    for (int scenario = 0; scenario < count_of(evaluation.runs); ++scenario) {
        const Run& run = evaluation.runs[scenario];
        if (!run.model) continue;
        for (const std::string& warning : core::stepper::branch_warnings(*run.model, run.simulation.trajectory))
            out.push_back(description::scenario_prefix(design, scenario) + warning);
        if (!run.simulation.balance) continue;
        if (const std::string warning = balance_warning(*run.model, *run.simulation.balance); !warning.empty())
            out.push_back(description::scenario_prefix(design, scenario) + warning);
    }
    const std::vector<std::string> peaks = doubtful_extremes(design, evaluation);
    out.insert(out.end(), peaks.begin(), peaks.end());
    return out;
}

}  // namespace fettle::design::problem
