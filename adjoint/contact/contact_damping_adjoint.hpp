// SPDX-License-Identifier: MIT
/// Damping of contacts (core/contact/contact_damping.hpp) in the bodies' motion, in the start poses P0 and in the
/// shapes' vertices, reverse and forward. With f_i = dphi/dx_i at the end, f0_i at P0, a = stiffness (phi - phi_t0) and a motion of the
/// bodies that moves the vertices at the end with v_i, its part of the step's residual along that motion is
///   r = sum_pairs a sum_i f_i . v_i.
#pragma once

#include <vector>

#include "adjoint/contact/contact_set_adjoint.hpp"
#include "core/contact/contact_damping.hpp"

namespace fettle::adjoint::contact {

/// Contacts at a step's end, and their damping since its start.
struct DampedContacts {
    const core::model::Model& model;
    const core::contact::ContactSet& contacts;
    const std::vector<core::kinematics::Pose>& poses;
    const core::contact::ContactDamping& damping;
    const core::contact::ContactAreas* areas = nullptr;  ///< of the same contacts, if the barrier is area-weighted
};

/// For every seed s, with the motion lambda[s][body] = (dq, phi) at the end and g = sum_i f_i . v_i:
///   vertices_bar -= dr/dX,  dr/dX_i = a R^T ((H v)_i - phi x f_i) + a sum_j (df_j/deps . v_j) deps/dX_i
///                                     + stiffness g (R^T f_i - R0^T f0_i + (dphi/deps - dphi_t0/deps) deps/dX_i),
///   start_bar[s][body] -= dr/dP0 = - stiffness g sum_i f0_i [X_i; 1]^T,
/// and where stiffness is area-weighted, of each pair's weight w: weight_bar -= r/w; and of the minimum separation, with
/// stiffness'/stiffness = 2 g_hat'/g_hat - 2/(dmin + dhat), dmin_bar -= (stiffness' (phi - phi_t0) + stiffness (phi - phi_t0)') g + a sum
/// df_i/ddmin . v_i.
struct DampingGradients {
    std::vector<std::vector<Matrix34>>& start_bar;
    std::vector<std::vector<AreaChange>>& areas_bar;  ///< irrelevant where nothing is area-weighted
    std::vector<ModelGradient>& model_bar;
};
void subtract_contact_damping_adjoint(const DampedContacts& at, const std::vector<std::vector<Vector6>>& lambda,
                                      const DampingGradients& to);

/// Changes of the end and of P0 (3x4 per body, any matrices), and of the areas.
struct DampingChanges {
    const std::vector<Matrix34>&poses_dot, &start_dot;
    const std::vector<AreaChange>& areas_dot;
};
/// Adds dE/dP (3x4 per body) of the damping and its change along those and vertices_dot.
void add_contact_damping_tangent(const DampedContacts& at, const DampingChanges& dot, const ModelTangent& direction,
                                 PoseGradientTangent& out);

}  // namespace fettle::adjoint::contact
