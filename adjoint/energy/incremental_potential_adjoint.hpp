// SPDX-License-Identifier: MIT
/// The terms of the incremental potential (core/energy/incremental_potential.hpp), differentiated in what a step holds constant: their
/// list, and their sums.
#pragma once

#include <span>

#include "adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

/// One for each of core's terms, in the same order.
std::span<const TermAdjoint* const> term_adjoints();

/// What the terms refuse.
Errors check_terms(const core::model::Model& model);

/// @param motion    [seed][body]: (dq, phi) of the adjoint variable.
/// @param step_bar  of the right sizes; added to.
void subtract_terms_reverse(const StepEnd& at, const std::vector<std::vector<Vector6>>& motion, StepGradient& step_bar,
                            std::vector<ModelGradient>& model_bar);

contact::PoseGradientTangent terms_tangent(const StepEnd& at, const StepTangent& step, const ModelTangent& direction);

}  // namespace fettle::adjoint::energy
