// SPDX-License-Identifier: MIT
/// The function that one time step minimises: inertia + loads + barrier + friction, over all bodies' poses. docs/method.md sections 3
/// and 6.
///   E(y) = sum E_d(P) - weight sum (f . (q - q_t0) + tau . theta) + barrier + friction, potentials times the integrator's weight.
/// Coordinates: each body's (q, theta) in the chart of the step, R = exp([theta]) R_t0.
#pragma once

#include <vector>

#include "fettle/core/contact/contact_set.hpp"
#include "fettle/core/contact/friction.hpp"
#include "fettle/core/energy/time_integration.hpp"
#include "fettle/core/kinematics/path.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::energy {

/// What is constant while the solver minimises.
struct StepProblem : IntegrationStep {
    const model::Model* model = nullptr;
    std::vector<kinematics::Pose> poses_t0;
    double kappa = 0;
    contact::BarrierParameters barrier;
    contact::FrictionSet friction;  ///< empty: none
};

/// The step that follows `history`, without friction until it is lagged (contact/friction.hpp).
StepProblem step_problem(const model::Model& model, const History& history, double kappa);

/// The barrier's stiffness from here on.
void set_kappa(StepProblem& problem, double kappa);

/// The implicit Euler step from `poses` with velocities Pdot, with the model's kappa.
StepProblem implicit_euler_problem(const model::Model& model, std::vector<kinematics::Pose> poses_t0,
                                   const std::vector<Matrix34>& velocities_t0);

std::vector<kinematics::Pose> poses_of(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points);

/// The value; infinity where a pair is at or below dmin. `poses` are those of `points` (poses_of).
double incremental_potential(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                             const std::vector<kinematics::Pose>& poses, const contact::Candidates& candidates);

/// First derivatives before any choice of coordinates (inertia, forces, barrier and friction; torques belong to the chart), and the
/// Gauss-Newton Hessian of barrier and friction.
struct PoseDerivatives {
    std::vector<kinematics::PoseGradient> gradients;  ///< per body
    kinematics::BlockHessian contact_hessian;         ///< tangent coordinates (q, phi)
    std::vector<double> force_magnitude;              ///< per body: sum of the magnitudes of the forces' parts, in gradient units per metre
};
PoseDerivatives pose_derivatives(const StepProblem& problem, const std::vector<kinematics::Pose>& poses,
                                 const contact::ContactSet& contacts, contact::HessianKind kind);

/// Gradient and Hessian in the step's chart coordinates.
struct ChartDerivatives {
    std::vector<Vector6> gradient;  ///< per body
    kinematics::BlockHessian hessian;
    std::vector<double> force_magnitude;  ///< as above
};
ChartDerivatives chart_derivatives(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                                   const std::vector<kinematics::Pose>& poses, const contact::ContactSet& contacts,
                                   contact::HessianKind kind);

}  // namespace fettle::core::energy
