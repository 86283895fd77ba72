// SPDX-License-Identifier: MIT
/// Ipopt (Waechter and Biegler 2006): interior point, filter line search, limited-memory quasi-Newton Hessian.
/// A failed evaluation is `return false`, at which its line search shortens the step. One solve per process at a time: Debian's MUMPS is
/// not thread-safe, so a mutex stands round OptimizeTNLP.
#pragma once

#include "fettle/design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

class IpoptOptimiser : public Optimiser {
public:
    std::string name() const override { return "ipopt"; }
    NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const override;
};

}  // namespace fettle::design::optimisers
