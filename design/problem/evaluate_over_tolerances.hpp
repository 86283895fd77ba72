// SPDX-License-Identifier: MIT
/// What a robust design (description/made_design.hpp) asks for over its tolerances, from simulations of the design as made.
///   value     y + offset(g)            g = dy/dd at d = 0, exact, of one simulation with derivatives (tolerances/robust_offset.hpp)
///   gradient  dy/dp + (dg/dp)^T w      by central differences of gradients at d = +-h w: two simulations with derivatives per direction w,
///                                      whatever the number of tolerances
/// h is such that the deviation that is moved by most, in its standard deviations, is moved by robust_step of one. Directions that are the
/// same up to their length are one; where there are more of them than tolerances, the differences are taken along each of these instead.
///
/// What is to be proven has its certified bounds (proven_clearance.hpp) for the value, and the gradient of its worst parts: no simulation.
///
/// A gradient that jumps between the three points (another witness of a clearance, another contact) has no derivative there: the difference
/// to that side counts on which it does not jump; where it jumps on both, none (RobustRow::is_at_kink). A point that cannot be simulated
/// leaves the difference to the other side; where neither can, the evaluation is not usable: so near to a jam nothing is robust.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "design/description/design.hpp"
#include "design/problem/design_evaluation.hpp"

namespace fettle::design::problem {

/// The share of a standard deviation. Differences of gradients err by its square times what the second order's third derivatives add, and
/// by the noise of gradients over it.
inline constexpr double robust_step = 1.0 / 32;

/// design.as_made->design, to be asked by several threads at once.
struct EvaluateAsMade {
    std::function<DesignEvaluation(const VectorX&, const EvaluateOptions&)> evaluate;
    /// Optional: of the constraints that a simulation changes nothing of, in their order, without one; nothing: they cannot be had.
    /// Directions that these alone name take no simulation.
    std::function<std::optional<optimisers::Rows>(const VectorX&)> rest_rows = {};
    /// Wanted by what is to be proven.
    std::function<Result<core::model::Model>(const VectorX&)> model_at = {};
};

/// @param p        The parameters as drawn.
/// @return as of the design as drawn, but for its relations, which are the caller's: they are missing, and do not count in `violation`.
/// Contract: design.as_made.
DesignEvaluation evaluate_over_tolerances(const description::Design& design, const EvaluateAsMade& as_made, const VectorX& p,
                                          const EvaluateOptions& options);

/// The same of some constraints that a simulation changes nothing of, without the reserves' derivatives, but for those of proven ones.
/// @param p     The parameters as drawn.
/// @param rows  Theirs, as made: gets the reserves, and loses the columns of parameters that tolerances alone have.
/// @return false: something that is to be proven cannot be.
bool add_reserves(const description::Design& design, const EvaluateAsMade& as_made, const VectorX& p, const std::vector<int>& constraints,
                  optimisers::Rows& rows);

}  // namespace fettle::design::problem
