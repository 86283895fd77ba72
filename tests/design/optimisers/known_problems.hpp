// SPDX-License-Identifier: MIT
/// A problem whose optimum is known, and runs of optimisers on such.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "core/base/limits.hpp"
#include "design/optimisers/optimisation.hpp"

namespace fettle::tests::design_support {

using namespace fettle::design::optimisers;

using fettle::core::base::infinity;

// min -x - y over x^2 + y^2 <= 1 in [-2, 2]^2: (1/sqrt 2, 1/sqrt 2). Points with x + y > `cliff` cannot be evaluated.
inline Problem disc_with_cliff(double cliff) {
    Problem p;
    p.start = VectorX::Constant(2, -0.5);
    p.lower = VectorX::Constant(2, -2);
    p.upper = VectorX::Constant(2, 2);
    p.constraint_lower = VectorX::Constant(1, -infinity);
    p.constraint_upper = VectorX::Constant(1, 1);
    p.evaluate = [cliff](const VectorX& x) {
        Evaluation e;
        if (x.sum() > cliff) {
            e.reason = "beyond the cliff";
            return e;
        }
        e.usable = true;
        e.objective = -x.sum();
        e.gradient = VectorX::Constant(2, -1);
        e.constraints = VectorX::Constant(1, x.squaredNorm());
        e.jacobian = 2 * x.transpose();
        e.violation = std::max(0.0, x.squaredNorm() - 1 - 1e-6);
        return e;
    };
    return p;
}

inline OptimiserReport run(const Problem& problem, const std::string& name, OptimiserOptions options = {}) {
    auto optimiser = make_optimiser(name);
    REQUIRE(optimiser);
    return optimise(problem, **optimiser, options);
}

inline OptimiserOptions tight(int evaluations) {
    OptimiserOptions options;
    options.tolerance = 1e-7;
    options.max_evaluations = evaluations;
    return options;
}

}  // namespace fettle::tests::design_support
