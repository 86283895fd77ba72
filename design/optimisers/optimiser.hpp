// SPDX-License-Identifier: MIT
/// The interface of optimisers. The run round one, and the verdict: optimisation.hpp.
/// Add an optimiser: derive from Optimiser, one file beside the others, one line in optimisation.cpp's table.
#pragma once

#include <functional>
#include <string>

#include "design/optimisers/evaluator.hpp"
#include "design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

struct OptimiserOptions {
    int max_evaluations = 200;
    double tolerance = 1e-4;            ///< of the objective: a gain that is smaller is not worth an evaluation (least_gain)
    double negligible = 0;              ///< a gain in the objective that does not count, however small the objective is
    double radius = 0.25;               ///< of the first step, of each variable's range
    bool meets_requirements = true;     ///< a step that meets what is missed is worth an evaluation, however small the gain; "sqp" asks
    bool judges = true;                 ///< false: the end is not looked at, and is never optimal: one search of many
    std::function<bool()> should_stop;  ///< optional (Ctrl-C)
    std::function<void(int, const VectorX&, const Evaluation&, bool best)> on_evaluation;  ///< optional
    std::function<void(const std::string&)> narrate;  ///< optional: what the evaluations that follow are for
};

/// Says it to whoever listens.
inline void narrate(const OptimiserOptions& options, const std::string& line) {
    if (options.narrate) options.narrate(line);
}

/// The gain in the scaled objective that counts: tolerance |f|, and where f goes to nothing a millionth of that at the start (of a sum of
/// squares: of its residuals at the start); never less than what is negligible.
double least_gain(const Evaluator& evaluator, const OptimiserOptions& options, double scaled_objective);

/// What a native optimiser says of itself, for people. Whether it calls its end a success decides nothing: the verdict is our own
/// (optimisation.hpp).
struct NativeOutcome {
    int iterations = 0;
    std::string message;  ///< its own words
};

class Optimiser {
public:
    virtual ~Optimiser() = default;
    virtual std::string name() const = 0;
    /// Works in the evaluator's scaled variables, from its best point so far, the start at first. A point that cannot be evaluated is
    /// handed to the native optimiser as a failure (it shortens its step), never as a number. Keeps StopOptimisation inside.
    virtual NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const = 0;
};

}  // namespace fettle::design::optimisers
