// SPDX-License-Identifier: MIT
/// The function that one time step minimises over all bodies' poses: the sum of its terms (term.hpp), potentials times the integrator's
/// weight. docs/method/energy.md and docs/method/solver.md.
///   E(y) = sum E_d(P) - weight sum (f . (q - q_t0) + tau . theta) + damping + barrier + contact damping
///          + friction + springs, dampers, stops, forces along measures
/// Coordinates: each body's (q, theta) in the chart of the step, R = exp([theta]) R_t0 (step_problem.hpp).
#pragma once

#include <span>
#include <vector>

#include "core/energy/term.hpp"

namespace fettle::core::energy {

/// Inertia, loads, damping; barrier, contact damping, friction, terms of measures: in the order of their sums.
std::span<const BodyTerm* const> body_terms();
std::span<const CouplingTerm* const> coupling_terms();

/// The value; infinity where a pair is at or below dmin. `poses` are those of `points` (poses_of), `contacts` those there.
double incremental_potential(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                             const std::vector<kinematics::Pose>& poses, const contact::ContactSet& contacts);

/// Gradient and Hessian in the step's chart coordinates.
struct ChartDerivatives {
    std::vector<Vector6> gradient;  ///< per body
    kinematics::BlockHessian hessian;
    /// Per body: the magnitudes of the sum of its contacts' forces, of each spring, stop, load and joint friction (what a spring that
    /// presses a part on its stop leaves of their sum is rounding), and of each part of its own forces, in gradient units per metre.
    std::vector<double> force_magnitude;
};
/// @param kind  projected: terms that couple bodies per pair, and each body's own 6 x 6 block with the curvature of its rotation, made
///              positive semi-definite. none: the Hessian stays empty.
ChartDerivatives chart_derivatives(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                   const std::vector<kinematics::Pose>& poses, const contact::ContactSet& contacts,
                                   contact::HessianKind kind);

/// What all terms report about a solved step.
TermReport term_report(const SolvedStep& step);

}  // namespace fettle::core::energy
