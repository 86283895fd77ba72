// SPDX-License-Identifier: MIT
/// Newmark's accelerations at the start (core/energy/start_history.hpp), reverse and forward. Each body's is that of
/// time_integration_adjoint.hpp under the loads L = (f, tau) - sum of the mechanism's terms' gradients at P0. With mu the bars of L as a
/// motion v of the bodies, the terms' part is - r(v), r of measure_terms_adjoint.hpp at the start: what those derivatives are in
/// coefficients, frames and rates; and in P0, with H the terms' Hessian in points and G = dE/dP,
///   dr = mu . H (dq, phi) + <[mu_phi]^T G_R, dR>.
#pragma once

#include <vector>

#include "adjoint/model_gradient.hpp"

namespace fettle::adjoint::energy {

/// Changes of what the start follows from, by body, beside a model's direction.
struct StartDirection {
    const ModelTangent& model;
    const std::vector<Matrix34>& poses_dot;  ///< of P0, entry by entry
    const std::vector<Matrix4>& moments_dot;
};
/// [body]; 0 of bodies that are prescribed altogether.
std::vector<Matrix34> start_accelerations_tangent(const core::model::Model& model, const StartDirection& direction);

/// What is added to, by seed: poses' and masses' by body.
struct StartGradient {
    std::vector<std::vector<Matrix34>>& poses_bar;
    std::vector<std::vector<Matrix4>>& moments_bar;
    std::vector<ModelGradient>& model_bar;
};
/// @param bar  [seed][body]: of the accelerations.
void start_accelerations_adjoint(const core::model::Model& model, const std::vector<std::vector<Matrix34>>& bar, const StartGradient& to);

}  // namespace fettle::adjoint::energy
