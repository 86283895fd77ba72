// SPDX-License-Identifier: MIT
/// First-order optimality of a design: what the verdict of a run rests on, and where the native optimisers stop.
#pragma once

#include "fettle/design/optimisers/evaluator.hpp"

namespace fettle::design::optimisers {

/// A design counts as optimal when its optimality residual is at most this (the objective's largest derivative at the start is 1) ...
inline constexpr double nearly_optimal = 5e-2;
/// ... where bounds and constraints within this (scaled) distance count as holding with equality.
inline constexpr double nearly_active = 1e-2;

/// Largest component of grad f - sum l_i n_i over l >= 0, all scaled, where n_i are the inward normals of the bounds and constraints that
/// hold with equality to within `active` (scaled): 0 at a point that satisfies the first-order conditions.
double optimality_residual(const Evaluator& evaluator, const VectorX& scaled_point, const Evaluation& scaled_evaluation, double active);

}  // namespace fettle::design::optimisers
