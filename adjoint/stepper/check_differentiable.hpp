// SPDX-License-Identifier: MIT
/// What of a model and its trajectory the sweeps refuse before they begin. What they refuse on the way, step by step: StepSolver::factorise
/// (step_linearisation.hpp).
#pragma once

#include "core/base/result.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// Names all that the sweeps cannot differentiate: what the terms refuse (adjoint/energy), bodies whose mass is not by their mesh and
/// density, scripts of poses (all unsupported); with friction a trajectory that does not hold where its rounds ended, or in which they have
/// not settled, steps that are not even or do not begin at t = 0, a prescribed coordinate that stops short of where its curve leads, or
/// goes farther (inconsistent); a step that turns a body by a full revolution or more, where the chart is singular (out_of_range).
/// Contract: the trajectory belongs to the model (number of bodies, time step).
Errors check_differentiable(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

}  // namespace fettle::adjoint::stepper
