// SPDX-License-Identifier: MIT
/// How firmly a quasi-static step holds what nothing else does. docs/method/energy.md#quasi-static-steps.
#pragma once

#include "core/model/model.hpp"

namespace fettle::core::model {

/// The load on a body [N]: m |gravity| + |force| + |torque| / r, r its radius, at least dhat. 0 for a body that is prescribed altogether.
double load_magnitude(const Model& model, const Body& body);

/// The loads that a body's proximal force is compared with [N]: its own, of a body without any the largest of the scene. 0: the scene has
/// none.
std::vector<double> reference_loads(const Model& model);

/// What share of a body's reference load the proximal term may carry before the body counts as not held.
inline constexpr double allowed_proximal_share = 1e-6;

/// W = h^2/eps [s^2] of the proximal term 1/2 (eps/h^2) |P - P_t|^2_M = |P - P_t|^2_M / (2 W):
///   W = D / (allowed_proximal_share a),   a = min over bodies of (reference load / mass),   D the scene's diagonal.
/// Its force on a body that moves by dx is m dx/W <= allowed_proximal_share (reference load) dx/D: a body that stays within the scene in a
/// step is held, whatever its mass; one that nothing holds would have to move by D. Independent of the time step, which quasi-statics knows
/// for prescribed motion and friction's slip only.
/// Without loads a = dhat / (40 h^2): that at which choose_kappa's two rules agree. 1 if nothing is free to move.
/// A constant of a simulation; of all designs of an optimisation that of the scene as written, so that no derivative knows of it.
double choose_proximal_weight(const Model& model);

}  // namespace fettle::core::model
