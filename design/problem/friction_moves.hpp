// SPDX-License-Identifier: MIT
/// The coefficients of friction that parameters move (description/parameter.hpp): where they are in the scene, and where their derivatives
/// are in its gradient. As mechanism_moves.hpp has it for joints, springs, motors and loads.
#pragma once

#include <string>

#include "fettle/adjoint/model/build_friction_adjoint.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/description/parameter.hpp"

namespace fettle::design::problem {

/// Why the scene has no such coefficient; empty: it has. Contract: is_of_friction(move.target).
std::string friction_misfit(const core::scene::Scene& scene, const description::Move& move);

/// Puts the coefficient where the move says. Contract: no misfit.
void set_coefficient(const description::Move& move, double value, core::scene::Scene& scene);

/// dJ/d(that coefficient).
double coefficient_gradient(const description::Move& move, const core::scene::Scene& scene,
                            const adjoint::model::SceneFrictionGradient& gradient);

/// A coefficient of 0 or less has no derivative: named. Empty: it is none.
Errors coefficient_moved_badly(const core::scene::Scene& scene, const description::Move& move);

}  // namespace fettle::design::problem
