// SPDX-License-Identifier: MIT
/// A design, simulated and measured: the question of DesignProblem::evaluate (design_problem.hpp), and its answer.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/simulate.hpp"
#include "design/description/design.hpp"
#include "design/description/requirement_text.hpp"
#include "design/optimisers/problem.hpp"
#include "design/problem/witness_branches.hpp"

namespace fettle::design::problem {

struct EvaluateOptions {
    bool gradients = true;
    std::function<void(const core::stepper::Progress&)> on_step;  ///< optional
    std::function<bool()> should_stop;                            ///< optional
    /// Optional: gets the evaluation when its values are known and its derivatives are not; of a design over tolerances never.
    std::function<void(const struct DesignEvaluation&)> on_values = {};
    bool balance = false;                      ///< fill in each run's Simulation::balance, for the warnings on energy: costs a few percent
    BranchReach branches = BranchReach::near;  ///< with gradients: `near` fills in the evaluation's branches, `tied` its ties
};

/// What was simulated.
struct Run {
    std::shared_ptr<const core::model::Model> model;  ///< null if it could not be built
    core::stepper::Simulation simulation;             ///< as far as it came
};

/// A constraint whose value has come to an end short of its bounds: how it goes on (description::Continuation).
struct ContinuedRow {
    int constraint = 0;
    double value = 0;    ///< SI
    std::string reason;  ///< for people
    VectorX gradient;    ///< d value / d parameters, SI; empty unless asked for
};

/// A constraint or a term of the objective that is asked for over the tolerances: its measurement has its reserve for them, is computed and
/// not proven (unless that is asked for: proven_clearance.hpp), and keeps the certificate of the design as drawn.
struct RobustRow {
    bool of_objective = false;
    int index = 0;                   ///< of the constraint or term
    description::Measurement drawn;  ///< without the reserve
    double mean = 0;                 ///< what the deviations' means add, SI
    double standard_deviation = 0;   ///< over the tolerances, SI
    double reserve = 0;              ///< what is added to the drawn value, SI
    VectorX gradient;                ///< d value / d deviation, per tolerance, SI
    VectorX deviations{};            ///< of a proven one: the deviations of the worst parts, SI
    bool is_at_kink = false;         ///< gradients jump close by: how the reserve changes from there is not known, and counts as nothing
};

/// A design, simulated and measured.
struct DesignEvaluation {
    bool usable = false;
    VectorX parameters;        ///< where, SI
    std::string reason;        ///< why not: the part that cannot be made, the bodies that intersect, what blocks the motor ...
    bool interrupted = false;  ///< not usable, because should_stop said so
    std::vector<Run> runs;     ///< one per scenario, at least one; none: a relation is not defined there
    std::vector<description::Measurement> terms;        ///< per objective term, SI
    std::vector<description::Measurement> constraints;  ///< per constraint, SI
    std::vector<ContinuedRow> continued;                ///< of some constraints, in their order: what a search sees of these instead
    optimisers::Rows relations;                         ///< values and gradients, of an unusable trial too
    double objective = std::nan("");                    ///< sum of weight * value / unit; NaN: not usable
    double violation = std::nan("");           ///< largest of the constraints' and relations' (description/constraint.hpp); NaN: not usable
    VectorX gradient;                          ///< d objective / d parameters, SI; empty unless asked for
    MatrixX jacobian;                          ///< d constraint values / d parameters, SI
    VectorX residuals;                         ///< the objective's deviations (optimisers/problem.hpp)
    MatrixX residual_jacobian;                 ///< of the objective's squared deviations (optimisers/problem.hpp), a row each
    optimisers::Branches constraint_branches;  ///< of clearances (optimisers/problem.hpp)
    optimisers::Branches objective_branches;   ///< the same of terms with a negative weight
    std::vector<Tie> ties;                     ///< if asked for: quantities whose derivative is one of several
    std::vector<RobustRow> robust;             ///< of a robust design: constraints, then terms of the objective
    double forward_seconds = 0;                ///< parts, model, simulation, values
    double backward_seconds = 0;               ///< seeds, sweep, chain
};

/// The constraints as a search sees them, with those that are continued: values, and derivatives (as `jacobian` has them), SI.
VectorX search_values(const DesignEvaluation& evaluation);
MatrixX search_jacobian(const DesignEvaluation& evaluation);
/// What is to be known of a constraint beside its numbers: its fault, or why it is continued; empty: nothing.
std::string remark(const DesignEvaluation& evaluation, std::size_t constraint);

/// What is known of a constraint (or a term) over the tolerances; null: it counts as drawn.
const RobustRow* robust_row(const DesignEvaluation& evaluation, bool of_objective, std::size_t index);

/// "as drawn 0.45 mm, sigma 0.05 mm", and what is to be known of its derivative; empty: it counts as drawn.
std::string reserve_text(const DesignEvaluation& evaluation, bool of_objective, std::size_t index, const description::CountedUnit& unit);

/// What all numbers over the tolerances rest on, for people: a sentence; empty where there are none.
std::string reserves_text(const description::Design& design);

/// The options for several simulations at the same time, as they are asked for one: should_stop is asked by one thread at a time.
EvaluateOptions for_several(EvaluateOptions options);

}  // namespace fettle::design::problem
