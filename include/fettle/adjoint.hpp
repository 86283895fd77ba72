// SPDX-License-Identifier: MIT
/// Derivatives of a whole simulation: backwards from what a motion comes to, forwards along a change of the model.
#pragma once

#include "fettle/adjoint/clearance/clearance_adjoint.hpp"
#include "fettle/adjoint/scene/scene_gradient.hpp"
#include "fettle/adjoint/stepper/reverse_sweep.hpp"
#include "fettle/adjoint/stepper/tangent_sweep.hpp"
#include "fettle/core.hpp"
