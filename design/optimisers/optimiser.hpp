// SPDX-License-Identifier: MIT
/// The interface of optimisers. The run round one, and the verdict: optimisation.hpp.
/// Add an optimiser: derive from Optimiser, one file beside the others, one line in optimisation.cpp's table.
#pragma once

#include <functional>
#include <string>

#include "fettle/design/optimisers/evaluator.hpp"
#include "fettle/design/optimisers/problem.hpp"

namespace fettle::design::optimisers {

struct OptimiserOptions {
    int max_evaluations = 200;
    double tolerance = 1e-4;            ///< relative change of the scaled objective, and optimality residual, below which it is done
    std::function<bool()> should_stop;  ///< optional (Ctrl-C)
    std::function<void(int, const VectorX&, const Evaluation&, bool best)> on_evaluation;  ///< optional
};

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
    /// Works in the evaluator's scaled variables, from evaluator.scaled_start(). A point that cannot be evaluated is handed to the native
    /// optimiser as a failure (it shortens its step), never as a number. Keeps StopOptimisation inside.
    virtual NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const = 0;
};

}  // namespace fettle::design::optimisers
