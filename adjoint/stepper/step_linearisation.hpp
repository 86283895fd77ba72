// SPDX-License-Identifier: MIT
/// One step, of implicit Euler or quasi-static, linearised about its solution: what the reverse and the forward sweep share. Everything is
/// computed anew from the trajectory's configurations (broad phase, contacts, true Hessian), so that a trajectory needs to store nothing
/// else.
#pragma once

#include "fettle/core/base/result.hpp"
#include "fettle/core/energy/incremental_potential.hpp"
#include "fettle/core/solver/linear_solver.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

struct LinearisedStep {
    core::energy::StepProblem problem;
    std::vector<core::kinematics::Pose> poses;         ///< at the step's end
    std::vector<core::kinematics::ChartPoint> points;  ///< the same in the step's chart
    core::contact::ContactSet contacts;                ///< at the step's end
    core::energy::ChartDerivatives derivatives;        ///< gradient and true Hessian in the chart (q, theta)
    core::energy::DerivativesAt end() const { return {problem, poses, contacts, core::contact::HessianKind::exact}; }
};

/// Step t, which leads from trajectory.poses[t] to poses[t + 1].
LinearisedStep linearise_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t);

/// Factorises the step's Hessian. Error (inconsistent): it is singular; names the step and the time.
Errors factorise(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step, core::solver::LinearSolver& solver);

/// H^-1 rhs over the free degrees of freedom, one column each, with one round of iterative refinement: the barrier makes H stiff.
MatrixX refined_solve(const core::solver::LinearSolver& solver, const core::solver::FreeDofs& dofs,
                      const core::kinematics::BlockHessian& hessian, const MatrixX& rhs);

/// What the sweeps cannot differentiate, by name: bdf2 and newmark, what the terms refuse (adjoint/energy: shells,
/// wires, points and solids with capped openings, torques, the area-weighted barrier, friction), scripts of poses (all unsupported); a step
/// that turns a body by a full revolution or more, where the chart is singular (out_of_range). Contract: the trajectory belongs to the
/// model (number of bodies, time step).
Errors check_differentiable(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// All three rotations free: the end pose then does not depend on where the step's chart is based.
bool rotates_freely(const core::model::Body& body);

}  // namespace fettle::adjoint::stepper
