// SPDX-License-Identifier: MIT
/// Sequential quadratic programming in a trust region, each step a quadratic programme that Ipopt solves (quadratic_program.hpp).
///
/// Evaluations are simulations, minutes of them, and the problem's models are rough on a small scale. So each step is the best that the
/// values and derivatives at the best point so far can say within a box:
///   minimise  g.d + 1/2 d.B d + penalty * violation(c + J d)   over |d_k| <= radius, within the bounds
/// with a row for each branch of a constraint (one violation for all of them), and for each kink of f what it adds to it
/// (elastic: from an infeasible point it is the feasibility phase as well), and one evaluation shows whether it was right: the decrease of
/// f + penalty * violation(c) is compared with the predicted one, the point is taken if it is a tenth of it or more, and the box grows or
/// shrinks with how well the prediction held (Nocedal and Wright, Numerical Optimization, 2nd ed., algorithm 18.4 with l1 penalty). A step
/// that is refused because constraints are curved is corrected once, by their values at its end (second-order correction, section 18.3;
/// without it long steps along curved constraints are all refused: the Maratos effect). B is
/// twice the residuals' J_r^T J_r (Gauss-Newton) and a symmetric rank-one estimate of the Lagrangian's other curvature, taken up only
/// where it explains the values better than without, made positive semi-definite. The penalty is raised until a step takes a tenth of the
/// violation that could be taken (Byrd, Nocedal and Waltz 2008). Derivatives are the problem's own, or those of the smoother model that it
/// was begun with, whichever predict the values better (with_telling_derivatives).
///
/// Done when the predicted decrease is below the tolerance, or the box below the least size worth a simulation.
#pragma once

#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

/// Which curvature B has.
enum class Curvature {
    estimated,    ///< all of the above
    gauss_newton  ///< where f is nothing but its residuals' squares, those alone: best where they can become nearly nothing
};

/// Called "sqp" and "gauss_newton".
class SequentialOptimiser : public Optimiser {
public:
    explicit SequentialOptimiser(Curvature curvature = Curvature::estimated) : curvature_(curvature) {}
    std::string name() const override { return curvature_ == Curvature::gauss_newton ? "gauss_newton" : "sqp"; }
    NativeOutcome minimise(Evaluator& evaluator, const OptimiserOptions& options) const override;

private:
    Curvature curvature_;
};

}  // namespace fettle::design::optimisers
