// SPDX-License-Identifier: MIT
/// The terms between bodies that are near each other (core/energy/contact_terms.hpp): the barrier in the shapes' vertices, damping of
/// contacts in the step's start too (the damping time is not differentiated), friction in what a solve holds constant. adjoint/contact does
/// the work.
#pragma once

#include "adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

extern const TermAdjoint barrier_term_adjoint;

extern const TermAdjoint contact_damping_term_adjoint;

/// Has it two bodies that may touch with a coefficient above 0?
bool has_friction(const core::model::Model& model);

extern const TermAdjoint friction_term_adjoint;

}  // namespace fettle::adjoint::energy
