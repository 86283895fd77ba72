// SPDX-License-Identifier: MIT
/// From a model's frames, rows and terms back to the scene's joints, springs, motors and loads that they were made of
/// (core/model/build_mechanism.hpp). Values as written that rests, screws, gears and motors count from depend on the poses as written too.
/// A frame's axes are, for an axis of length |a|, z = a/|a|, and across it
///   x = unit(e x z), y = z x x, e the world's axis least along z;   of end b, as far as the two axes are not across each other,
///   x = unit((1 - z z^T) R_b^T R_a x_a), y = z x x.
/// Constants are the stiffness of stops, and the radius by which stops and friction of angles are measured (core/model/build_mechanism.hpp,
/// TermScales).
#pragma once

#include "adjoint/model/mechanism_start_adjoint.hpp"
#include "core/scene/scene.hpp"

namespace fettle::adjoint::model {

/// @param gradient  of the model, after MechanismStartAdjoint::reverse.
/// @param start     poses as written: added to.
/// @param bar       adjoint/scene/scene_gradient.hpp, the mechanism's: added into.
/// Contract: the model was built from the scene; a load whose force is 0 has no frames and no derivative, for the caller to refuse.
void build_mechanism_adjoint(const core::scene::Scene& scene, const core::model::Model& model, const MechanismGradient& gradient,
                             WrittenStartGradient& start, core::scene::Mechanism& bar);

}  // namespace fettle::adjoint::model
