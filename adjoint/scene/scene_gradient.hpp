// SPDX-License-Identifier: MIT
/// The derivative of a number in a scene is a scene: where the one has a number x, at a place of core/scene/place.hpp, the other has dJ/dx.
/// Besides these, bodies' mesh.vertices (3 x n, file frame) and pose, whose rotation is entry by entry, as if they could be anything; R's
/// part is defined up to what a rotation cannot do. What is no number is not there, but for names of dimensions and materials.
#pragma once

#include "core/scene/scene.hpp"

namespace fettle::adjoint::scene {

/// All numbers 0, at the places of `scene`.
core::scene::Scene zero_scene_gradient(const core::scene::Scene& scene);

}  // namespace fettle::adjoint::scene
