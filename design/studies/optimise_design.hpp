// SPDX-License-Identifier: MIT
/// Optimises a design: optimiser, final evaluation with certificates, what limits it. In memory: nothing is read or written but the
/// history, if one is given. For a design file, with its files: optimise_file.hpp.
///
///     const auto problem = design::problem::DesignProblem::create(std::move(made));  // a design from a file, or made in memory
///     if (!problem) return 3;
///     const auto outcome = design::studies::optimise_design(*problem);
///     if (!outcome) return 3;
///     std::printf("%s: %s\n", to_string(outcome->report.status), outcome->report.message.c_str());
///     for (int k = 0; k < problem->parameter_count(); ++k)
///         std::printf("%s = %g\n", problem->design().parameters[k].name.c_str(), outcome->report.point[k]);
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/branch_of_joint.hpp"
#include "design/gradient_audit/gradient_warnings.hpp"
#include "design/optimisers/optimisation.hpp"
#include "design/problem/design_problem.hpp"
#include "design/studies/history.hpp"
#include "design/studies/judged_design.hpp"

namespace fettle::design::studies {

struct OptimiseOptions {
    std::string optimiser;   ///< empty: what the design says
    std::uint64_t seed = 0;  ///< where it begins: random_start.hpp
    /// Instead of the design's objective: the smallest change of the design's own values that meets every requirement
    /// (nearest_design.hpp), to half a percent or the design's tolerance. `report` counts in that objective, `final` in the design's.
    bool repair = false;
    std::function<bool()> should_stop;                            ///< optional
    std::function<void(const std::string&)> narrate;              ///< optional: a line per evaluation
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
    /// Optional: each design that was tried, by its number: values, what came of it, is it the best so far?
    std::function<void(int, const VectorX&, const optimisers::Evaluation&, bool)> on_evaluation = {};
    History* history = nullptr;  ///< optional: answers what it has, and keeps newly computed results
    /// Nothing is tried that the history does not have: the run ends there, interrupted, with the best design so far.
    bool replay_only = false;
};

/// What was asked for, as the design as it was before measures it, SI; empty if it could not be evaluated.
struct MeasuredAtStart {
    std::vector<double> constraints, terms;  ///< in the design's order
};

/// The design that was found is judged as it is; `final` is not usable if the start was not.
struct OptimiseOutcome : JudgedDesign {
    optimisers::OptimiserReport report;
    VectorX start;  ///< where it began
    /// On which sides joints say that closed linkages are assembled: the same at the start and at the end.
    std::vector<core::model::JointSide> sides;
    MeasuredAtStart measured_at_start;
    std::optional<double> objective_start;  ///< the design's own objective there, if it could be evaluated
    /// What the derivatives of the first design say that could be evaluated: narrated before the search goes on from it.
    gradient_audit::GradientWarnings at_start;
    std::vector<std::string> limits;       ///< what holds an infeasible design back (limits.hpp)
    std::vector<std::string> unbuildable;  ///< what within the bounds makes no design, found before the first simulation (buildable.hpp)
    int replayed = 0;                      ///< evaluations that the history answered
};

/// From a random start (a seed other than 0) a design in which no contact is possible, whose simulations are cheap, is searched again
/// from other random places (later_start_of_seed) for as long as `max_evaluations` leaves evaluations, and three searches have not ended
/// with the same objective; the best search counts. Where a search from a random start meets no design that does what is required, others
/// follow from other random places, while there are evaluations left.
/// The design on the sides that its joints say; those of the seed are problem_of_seed's (starting_sides.hpp).
/// Deterministic: the same design and options give the same sequence of evaluations, bit for bit.
/// Errors: the optimiser's name.
Result<OptimiseOutcome> optimise_design(const problem::DesignProblem& problem, const OptimiseOptions& options = {});

/// An evaluation as the history keeps it. Throws optimisers::Interrupted if it was.
HistoryEntry history_entry(const description::Design& design, const VectorX& p, const problem::DesignEvaluation& evaluation);

}  // namespace fettle::design::studies
