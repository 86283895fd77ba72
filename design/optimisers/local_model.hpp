// SPDX-License-Identifier: MIT
/// A model of a problem round one evaluated point, from what is known there, and the gain that it promises.
#pragma once

#include <optional>

#include "design/optimisers/evaluator.hpp"
#include "design/optimisers/quadratic_program.hpp"

namespace fettle::design::optimisers {

/// Curvature of the Lagrangian f - y.c beside the residuals' own (Gauss-Newton): a symmetric rank-one estimate (Nocedal and Wright,
/// section 6.2) from the gradients at pairs of points, taken up only where it explains their values better than without it.
class RestCurvature {
public:
    explicit RestCurvature(int n) : matrix_(MatrixX::Zero(n, n)) {}
    const MatrixX& matrix() const { return matrix_; }
    /// Terms of f that have branches are left out at both points: their gradients jump, which is no curvature.
    /// @param step  From the first point to the second (Evaluator::step_between).
    /// @param y     Multipliers of the constraints, scaled (smooth_multipliers).
    void learn(const Evaluation& from, const VectorX& step, const Evaluation& to, const VectorX& y);

private:
    MatrixX matrix_;
};

/// f - y.c's gradient, without the terms of f that have branches.
VectorX lagrangian_gradient(const Evaluation& e, const VectorX& y);

/// 2 sum_i dr_i dr_i^T of the squared deviations that the objective has; zero if it has none.
MatrixX residual_curvature(const Evaluation& e);

/// The multipliers of a solution, without those of constraints whose branches hold the step as well: their gradients jump.
VectorX smooth_multipliers(const QuadraticSolution& solution);

/// Those of the constraints as wholes: each with its branches'. What raising its bound costs.
VectorX whole_multipliers(const QuadraticSolution& solution);

/// The best step from a scaled point within |d_k| <= radius and the bounds, by what the evaluation there says: branches are cuts, in the
/// order of constraint_branches, then of objective_branches but each term's first. The multipliers of cuts have the sign of their
/// constraint's: >= 0 of a lower bound, <= 0 of an upper one of values that are the greatest.
/// @param rest  Curvature beside the residuals'; null: none.
QuadraticSolution best_step(const Evaluator& evaluator, const VectorX& point, const Evaluation& e, const MatrixX* rest, double radius,
                            double penalty);

/// The shortest step from a scaled point to where the rows, as linearised there, meet what is aimed at; within |d_k| <= radius and the
/// bounds. Its `decrease` means nothing.
QuadraticSolution restoring_step(const Evaluator& evaluator, const VectorX& point, const Evaluation& e, double radius, double penalty);

/// The evaluation at a scaled point with, row by row (residuals, constraints), those derivatives that predict the values at the other
/// points near it better: its own, or those of the smoother model (EvaluatorOptions::reference). A rough function's own derivatives hold
/// over microns. With no other point to compare, the smoother model's.
Evaluation with_telling_derivatives(const Evaluator& evaluator, const VectorX& point, const Evaluation& e);

/// f + penalty * violation of the targets, scaled: what a step has to bring down.
double merit(const Evaluator& evaluator, const Evaluation& e, double penalty);

/// The sum by which the targets are missed, scaled.
double target_violation(const Evaluator& evaluator, const Evaluation& e);

}  // namespace fettle::design::optimisers
