// SPDX-License-Identifier: MIT
/// The numbers and vectors of a scene's joints, springs, motors and loads that parameters move (description/parameter.hpp): where they are
/// in the scene, and where their derivatives are in its gradient.
#pragma once

#include <string>

#include "fettle/adjoint/model/build_mechanism_adjoint.hpp"
#include "fettle/core/base/result.hpp"
#include "fettle/core/scene/scene.hpp"
#include "fettle/design/description/parameter.hpp"

namespace fettle::design::problem {

/// Why the scene's mechanism has nothing that a move of this kind moves; empty: it has. Contract: is_of_mechanism(move.target).
std::string misfit(const core::scene::Mechanism& mechanism, const description::Move& move);

/// Puts a number where the move says. Contract: no misfit, and no vector.
void set_number(const description::Move& move, double value, core::scene::Mechanism& mechanism);
/// The vector that the move says. Contract: no misfit, and a vector.
Vector3& vector_of(const description::Move& move, core::scene::Mechanism& mechanism);

/// dJ/d(that number).
double number_gradient(const description::Move& move, const adjoint::model::SceneMechanismGradient& gradient);
/// dJ/d(that vector).
Vector3 vector_gradient(const description::Move& move, const adjoint::model::SceneMechanismGradient& gradient);

/// What a moved number or vector must not be, for then it has no derivative, or no meaning: springs, dampers and joint friction of 0 or
/// less (at 0 there is none), loads of no force, limits out of order. Named; empty: nothing of the kind.
Errors moved_badly(const core::scene::Mechanism& mechanism, const description::Move& move);

}  // namespace fettle::design::problem
