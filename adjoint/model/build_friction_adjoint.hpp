// SPDX-License-Identifier: MIT
/// From the coefficients of friction of pairs of bodies back to the scene's: those of pairs of materials, of bodies, of materials, and the
/// one of all others (core/scene/scene.hpp). mu = sqrt(mu_a mu_b) of two bodies' own has dmu/dmu_a = sqrt(mu_b/mu_a)/2.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fettle/adjoint/model_gradient.hpp"
#include "fettle/core/scene/scene.hpp"

namespace fettle::adjoint::model {

/// dJ/d(core::scene::Friction), and of the bodies' own coefficients.
struct SceneFrictionGradient {
    double mu = 0;
    std::map<std::string, double> materials;  ///< those that are not there: 0
    std::vector<double> pairs;                ///< [pair of materials]
    std::vector<double> bodies;               ///< [body]; 0 of bodies without a coefficient of their own
};

/// Contract: the model was built from the scene; pairs of bodies in `gradient` have coefficients above 0.
SceneFrictionGradient build_friction_adjoint(const core::scene::Scene& scene, const FrictionGradient& gradient);

}  // namespace fettle::adjoint::model
