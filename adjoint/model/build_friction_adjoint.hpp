// SPDX-License-Identifier: MIT
/// From the coefficients of friction of pairs of bodies back to the scene's: those of pairs of materials, of bodies, of materials, and the
/// one of all others (core/scene/scene.hpp). mu = sqrt(mu_a mu_b) of two bodies' own has dmu/dmu_a = sqrt(mu_b/mu_a)/2.
#pragma once

#include "adjoint/model_gradient.hpp"
#include "core/scene/scene.hpp"

namespace fettle::adjoint::model {

/// @param bar  adjoint/scene/scene_gradient.hpp; added into.
/// Contract: the model was built from the scene; pairs of bodies in `gradient` have coefficients above 0.
void build_friction_adjoint(const core::scene::Scene& scene, const FrictionGradient& gradient, core::scene::Scene& bar);

}  // namespace fettle::adjoint::model
