// SPDX-License-Identifier: MIT
/// The function that one time step minimises: inertia + loads + barrier, over all bodies' poses. method.md sections 3 and 6.
/// Coordinates: each body's (q, theta) in the chart of the step, R = exp([theta]) R_t0.
#pragma once

#include <vector>

#include "fettle/core/contact/contact_set.hpp"
#include "fettle/core/kinematics/path.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::energy {

/// What is constant during a step.
struct StepProblem {
    const model::Model* model = nullptr;
    std::vector<kinematics::Pose> poses_t0;
    std::vector<Matrix34> pose_hat;  ///< per body; unused without free degrees of freedom
    double weight = 0;               ///< factor on potential energies: h^2 for implicit Euler [s^2]
    contact::BarrierParameters barrier;
};

/// The implicit Euler step from `poses` with velocities Pdot.
StepProblem implicit_euler_problem(const model::Model& model, std::vector<kinematics::Pose> poses_t0,
                                   const std::vector<Matrix34>& velocities_t0);

std::vector<kinematics::Pose> poses_of(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points);

/// The value; infinity where a pair is at or below dmin.
double incremental_potential(const StepProblem& problem, const std::vector<kinematics::Pose>& poses, const contact::Candidates& candidates);

/// First derivatives before any choice of coordinates (inertia, loads and barrier), and the Gauss-Newton Hessian of barrier alone.
struct PoseDerivatives {
    std::vector<kinematics::PoseGradient> gradients;  ///< per body
    kinematics::BlockHessian barrier_hessian;         ///< tangent coordinates (q, phi)
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
