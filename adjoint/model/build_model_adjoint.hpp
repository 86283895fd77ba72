// SPDX-License-Identifier: MIT
/// From a model back to the scene that it was built of (core/setup/build_model.hpp), reference points, dhat, kappa and the scales of terms
/// held. With q = R c + x for the reference point c of a body's file frame, and increments of prescribed coordinates linear in their rates;
/// of a model with joints through the start's assembly (mechanism_start_adjoint.hpp) to what was written.
#pragma once

#include "adjoint/model/mechanism_start_adjoint.hpp"
#include "adjoint/model_gradient.hpp"
#include "core/scene/scene.hpp"

namespace fettle::adjoint::model {

/// @param start  The model's.
/// @return  dJ/d(scene) (adjoint/scene/scene_gradient.hpp); dimensions of shapes and turns, which meshes and poses are made of: 0.
/// Contract: the model was built from the scene, whose moved numbers have no faults (core/scene/place.hpp).
core::scene::Scene build_model_adjoint(const core::scene::Scene& scene, const core::model::Model& model, const MechanismStartAdjoint& start,
                                       ModelGradient gradient);

}  // namespace fettle::adjoint::model
