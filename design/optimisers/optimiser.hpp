// SPDX-License-Identifier: MIT
/// The interface of optimisers, and the run round one: start, native optimiser, our own verdict. A native return code is never the verdict:
/// NLopt can return a wrong answer with a success code, Ipopt a good one with a failure's. Feasibility is judged by the evaluation's
/// `violation` (certificates), optimality by the residual of the Karush-Kuhn-Tucker conditions at the best point.
/// Add an optimiser: derive from Optimiser, one file beside the others, one line in optimiser.cpp's table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/optimisers/evaluator.hpp"
#include "fettle/design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

struct OptimiserOptions {
    int max_evaluations = 200;
    double tolerance = 1e-4;            ///< relative change of the scaled objective, and optimality residual, below which it is done
    std::function<bool()> should_stop;  ///< optional (Ctrl-C)
    std::function<void(int, const VectorX&, const Evaluation&, bool best)> on_evaluation;  ///< optional
};

/// What a native optimiser says of itself.
struct NativeOutcome {
    bool success = false;
    int iterations = 0;
    std::string message;  ///< its own words, for people
};

class Optimiser {
public:
    virtual ~Optimiser() = default;
    virtual std::string name() const = 0;
    /// Works in the evaluator's scaled variables, from evaluator.scaled_start(). A point that cannot be evaluated is handed to the native
    /// optimiser as a failure (it shortens its step), never as a number. Keeps StopOptimisation inside.
    virtual NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const = 0;
};

enum class OptimiserStatus {
    converged,          ///< feasible, and the native optimiser ended of itself
    budget_spent,       ///< feasible, but max_evaluations came first
    infeasible,         ///< the native optimiser ended at a design that violates a requirement
    infeasible_budget,  ///< max_evaluations came before a feasible design was found
    not_converged,      ///< feasible, but the native optimiser gave up
    interrupted,        ///< should_stop; the best design so far
    start_failed        ///< the start cannot be evaluated
};
const char* to_string(OptimiserStatus status);

/// A design counts as optimal when its optimality residual is at most this (the objective's largest derivative at the start is 1) ...
inline constexpr double nearly_optimal = 5e-2;
/// ... where bounds and constraints within this (scaled) distance count as holding with equality.
inline constexpr double nearly_active = 1e-2;

struct OptimiserReport {
    OptimiserStatus status = OptimiserStatus::start_failed;
    std::string message;  ///< for people: what ended it, in the native optimiser's words too
    Evaluation start;
    VectorX point;  ///< the best design (the start if nothing could be evaluated)
    Evaluation best;
    bool feasible = false;  ///< best.violation <= 0
    double optimality = 0;  ///< residual of the optimality conditions at the best point, scaled; see optimality_residual
    int evaluations = 0, failures = 0, iterations = 0;
};

/// Deterministic: the same problem and options give the same sequence of evaluations.
/// Throws what Problem::evaluate throws (Interrupted excepted).
OptimiserReport optimise(const Problem& problem, const Optimiser& optimiser, const OptimiserOptions& options);

const std::vector<std::string>& optimiser_names();
/// Errors: an unknown name (out_of_range), the message lists those known.
Result<std::unique_ptr<Optimiser>> make_optimiser(const std::string& name, const std::string& where = {});

/// Largest component of grad f - sum l_i n_i over l >= 0, all scaled, where n_i are the inward normals of the bounds and constraints that
/// hold with equality to within `active` (scaled): 0 at a point that satisfies the first-order conditions.
double optimality_residual(const Evaluator& evaluator, const VectorX& scaled_point, const Evaluation& scaled_evaluation, double active);

}  // namespace fettle::design::optimisers
