// SPDX-License-Identifier: MIT
/// The one checker of derivatives for all tests: central differences over a sweep of step sizes, the transpose identity, and the
/// slope of the Taylor remainder. On a manifold, hand in the function of the tangent coordinates and x = 0:
///     check_gradient([&](const VectorX& d) { return energy(plus(pose, d)); }, VectorX::Zero(6), gradient)
#pragma once

#include <functional>

#include "core/base/types.hpp"

namespace fettle::tests::support {

using ScalarFunction = std::function<double(const VectorX&)>;
using VectorFunction = std::function<VectorX(const VectorX&)>;

/// Step sizes h tried: largest, largest * factor, ... (`count` of them), in units of x. One h serves the whole derivative.
struct StepSweep {
    double largest = 1e-1;
    double factor = 0.25;
    int count = 16;
};

struct DerivativeCheck {
    double relative_error = 0;  ///< max |analytic - difference| / max(|analytic|, |difference|), at the best step; infinity if not finite
    double step = 0;            ///< where that was
    int row = 0, column = 0;    ///< of the largest error (row 0 for a gradient)
    double analytic = 0, difference = 0;  ///< there
};

/// Gradient of f at x against (f(x + h e_i) - f(x - h e_i)) / 2h. Both all zero: error 0.
DerivativeCheck check_gradient(const ScalarFunction& f, const VectorX& x, const VectorX& gradient, const StepSweep& sweep = {});

/// Jacobian (m x n) of f: R^n -> R^m; a Hessian is the Jacobian of the gradient.
DerivativeCheck check_jacobian(const VectorFunction& f, const VectorX& x, const MatrixX& jacobian, const StepSweep& sweep = {});

/// Along one direction: J v against (f(x + h v) - f(x - h v)) / 2h.
DerivativeCheck check_directional(const VectorFunction& f, const VectorX& x, const VectorX& direction,
                                  const VectorX& jacobian_times_direction, const StepSweep& sweep = {});

/// Largest |<w, Jv> - <J^T w, v>| / (|w| |Jv| + |J^T w| |v|) over `trials` pseudo-random v in R^n, w in R^m (the same on every run).
/// Rounding gives about 1e-16; a wrong transpose about 1.
double check_transpose(const VectorFunction& times, const VectorFunction& transpose_times, int n, int m, int trials = 5);

struct TaylorCheck {
    double slope = 0;             ///< of ln |f(x + h d) - f(x) - h g.d| over ln h: 2 or more for a right gradient, 1 for a wrong one
    int points = 0;               ///< step sizes whose remainder stands clear of rounding
    bool below_rounding = false;  ///< the remainder is rounding everywhere (f is affine along d and g is right): no slope to measure
    bool ok() const { return below_rounding || (points >= 3 && slope > 1.8); }
};
TaylorCheck check_taylor(const ScalarFunction& f, const VectorX& x, const VectorX& gradient, const VectorX& direction,
                         const StepSweep& sweep = {});

}  // namespace fettle::tests::support
