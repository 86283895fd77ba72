// SPDX-License-Identifier: MIT
/// One design, judged: its measures, the certificates of its clearances, and other models of the same motion that could say otherwise.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/clearance/pair_clearance.hpp"
#include "design/problem/design_problem.hpp"
#include "design/studies/resolution.hpp"

namespace fettle::design::studies {

struct JudgedDesign {
    problem::DesignEvaluation final;
    /// The same design with the play of its fits taken up (problem::play_taken_up): where the two differ, the motion within the play
    /// matters. Not usable where there is no such model, or it cannot be simulated.
    problem::DesignEvaluation play_taken_up;
    std::string play_taken_up_by;   ///< that model's name
    std::string play_not_compared;  ///< why there is none though there are fits; empty: there is one, or there are none
    std::vector<size_t> in_doubt;   ///< requirements that are met as written, and not with the play taken up
    /// By finer facets and time steps; of a design that is simulated once more alone (resolution.hpp), else without runs.
    FinerReport finer;
    std::vector<core::clearance::PairClearance> clearance;  ///< the certificates of all clearance constraints, in their order
};

struct JudgeOptions {
    std::function<bool()> should_stop;                            ///< optional; stops the comparison with the play taken up alone
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
};

/// Without `finer`. @param p  The values of the parameters, SI.
JudgedDesign judge_design(const problem::DesignProblem& problem, const VectorX& p, const JudgeOptions& options = {});

/// The same of a design that has been evaluated already, with its gradients or without.
JudgedDesign judge_design(const problem::DesignProblem& problem, problem::DesignEvaluation evaluated, const JudgeOptions& options = {});

/// Which requirements a design meets, and not by the values of another model of the same motion: what a proof is worth there depends on
/// which of the two a real mechanism is like. None where the other is not usable; of what no motion changes none.
std::vector<size_t> requirements_in_doubt(const description::Design& design, const problem::DesignEvaluation& own,
                                          const problem::DesignEvaluation& other);

}  // namespace fettle::design::studies
