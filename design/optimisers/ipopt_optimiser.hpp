// SPDX-License-Identifier: MIT
/// Ipopt's interior-point method with a filter line search (Waechter and Biegler 2006), run on the whole problem: its variables within
/// [0, 1], constraints and relations as rows, curvature from gradients (limited-memory BFGS). It does not know of branches, residuals or
/// smoother derivatives, which "sqp" uses (sequential_optimiser.hpp). Failures: a point that is refused or cannot be evaluated has no
/// value, and Ipopt halves its step.
#pragma once

#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

class IpoptOptimiser : public Optimiser {
public:
    std::string name() const override { return "ipopt"; }
    NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const override;
};

}  // namespace fettle::design::optimisers
