// SPDX-License-Identifier: MIT
/// NLopt's MMA and CCSAQ (Svanberg 2002), SLSQP (Kraft 1994), and COBYLA (Powell 1994), which uses no derivatives and is there to compare
/// with. Failures: MMA and CCSAQ get NaN, from which they recover; SLSQP and COBYLA do not, so that for them the run is started again from
/// the best point, within a box that the failed point lies outside of.
#pragma once

#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

enum class NloptAlgorithm { mma, ccsaq, slsqp, cobyla };

class NloptOptimiser : public Optimiser {
public:
    explicit NloptOptimiser(NloptAlgorithm algorithm) : algorithm_(algorithm) {}
    std::string name() const override;
    NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const override;

private:
    NloptAlgorithm algorithm_;
};

}  // namespace fettle::design::optimisers
