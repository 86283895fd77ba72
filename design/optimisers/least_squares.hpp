// SPDX-License-Identifier: MIT
/// The method of Levenberg and Marquardt for f = sum_i r_i^2 within bounds, in a trust region of the shape that the residuals have:
///   (J_F^T J_F + lambda D_F^2) d_F = -J_F^T r,   D_k the largest norm that column k of J has had,
/// F the variables that no bound holds. A box of equal shares of the ranges, as sequential_optimiser.hpp has it, fits a problem whose
/// bounds say how far its variables reach; of the lengths of a linkage bounds say little (a path of 1 mm, bounds of 50), and the box is
/// too narrow for one variable and too wide for another at the same time. lambda begins near nothing: from a far start the whole step of
/// Gauss and Newton most often leads to the basin where the mechanism fits its task. Where a first step shorter than the usual one is asked
/// for (OptimiserOptions::radius), because the start is a good one already, it begins larger.
/// Source: More 1978, The Levenberg-Marquardt algorithm (the scale D); Nielsen 1999, Damping parameter in Marquardt's method (lambda).
#pragma once

#include "design/optimisers/optimiser.hpp"

namespace fettle::design::optimisers {

/// Whether the evaluation's objective is the sum of its squared residuals, and nothing else.
bool is_sum_of_squares(const Evaluation& e);

/// Can minimise_squares be used from the evaluator's best point? There are no constraints, and f is such a sum.
bool is_least_squares(const Evaluator& evaluator);

/// Done when two steps one after another promise, and gain, less than least_gain at this tolerance. Evaluates where refusal says nothing.
/// Contract: is_least_squares.
NativeOutcome minimise_squares(Evaluator& evaluator, const OptimiserOptions& options, double tolerance);

}  // namespace fettle::design::optimisers
