// SPDX-License-Identifier: MIT
/// Friction (core/energy/friction.hpp) in what a solve holds constant: adjoint/contact does the work.
#pragma once

#include "fettle/adjoint/energy/term_adjoint.hpp"

namespace fettle::adjoint::energy {

/// Has it two bodies that may touch with a coefficient above 0?
bool has_friction(const core::model::Model& model);

extern const TermAdjoint friction_term_adjoint;

}  // namespace fettle::adjoint::energy
