// SPDX-License-Identifier: MIT
/// The verdict on a design: is there anything left to gain, as far as can be seen?
///
/// At the best point the local model (local_model.hpp: derivatives, Gauss-Newton, the curvature that the evaluations near it show) predicts
/// how much the objective falls along the best step that keeps the constraints, within a tenth of each range. Where that is below the
/// tolerance, the design is optimal. Where it is not, the step is tried: a gain that comes true is kept, and the run goes on from there; a
/// gain that does not teaches the model, and the step is shortened. Where a clearance has several witnesses near its least one, the step
/// keeps them all, and a term of the objective that is the greatest of several is taken as that: at a kink no single derivative suffices.
/// The search has kept a margin to what is required. Where nothing is left to gain with it, steps go to within a twentieth of it, or a
/// quarter where that was not enough, and a design that could gain so is not optimal, even if shorter steps promise nothing. A step that
/// misses a requirement by less than its margin, because requirements curve, is followed by the shortest step back. Where no gain is left
/// to first order, one or two designs are looked at aside, along directions that neither requirements nor bounds hold and that nothing
/// evaluated has told of (unexplored.hpp): a saddle is left for what is found there. A step that promises a gain and leads to designs that
/// cannot be evaluated, however short it is made, shows no optimum either: what stands in the way is no requirement that was asked for.
/// Values that scatter by more than the tolerance (noise.hpp: the objective's own noise, and each constraint's times its multiplier) show
/// no optimum, whatever the derivatives say. A sum of squares that is itself no more than a gain that counts is optimal without a look:
/// it is never below 0.
#pragma once

#include <string>
#include <vector>

#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

enum class Held { stationary, lower_bound, upper_bound, constraints, free };
const char* to_string(Held held);

struct Optimality {
    /// false: the budget or the user ended it before, no step could be computed, or the noise could not be measured; then nothing below is
    /// complete.
    bool judged = false;
    double predicted_gain = 0;  ///< in the objective, of the last step looked at
    double worth = 0;           ///< the gain that counts
    double radius = 0;          ///< of that step, of the variables' ranges
    VectorX step;               ///< n, in the variables' units
    VectorX multipliers;     ///< m: objective per unit of the bound, > 0: raising the lower bound costs, < 0: lowering the upper one does
    VectorX residual;        ///< n: objective per range that neither bounds nor constraints hold
    std::vector<Held> held;  ///< n; free: all of `improvable`, and what else only the length of the last step holds
    std::string refused;     ///< why the designs that this step leads to cannot be evaluated; empty: they can, or it promises nothing
    std::vector<int> improvable;    ///< variables that could still move, largest gain first; empty where the predicted gain does not count
    VectorX noise;                  ///< 1 + m: of objective and constraints; empty: not measured
    double noise_in_objective = 0;  ///< what the noise does to the objective at most
    int roughest = -1;              ///< which of `noise` does most of that, if it is above `worth`; else -1

    bool is_optimal() const { return judged && improvable.empty() && roughest < 0; }
};

/// The verdict in a few words, for people.
std::string words(const Optimality& optimality);

/// Judges the evaluator's best point, which is feasible; evaluates probes and noise as needed.
/// @param moved  Set where a probe became the new best: the run can go on from it.
Optimality judge(Evaluator& evaluator, const OptimiserOptions& options, bool& moved);

}  // namespace fettle::design::optimisers
