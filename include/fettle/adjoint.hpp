// SPDX-License-Identifier: MIT
/// Derivatives of a whole simulation: backwards from what a motion comes to, forwards along a change of the model.
#pragma once

#include "adjoint/clearance/clearance_adjoint.hpp"
#include "adjoint/scene/scene_gradient.hpp"
#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "fettle/core.hpp"
