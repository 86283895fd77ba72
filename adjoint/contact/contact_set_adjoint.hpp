// SPDX-License-Identifier: MIT
/// The barrier's forces, differentiated in the bodies' motion and in the shapes' vertices, reverse and forward.
/// With f_i = d(potential)/dx_i at the world vertices x_i = R X_i + q of each pair, and a motion of the bodies that moves them
/// with v_i, the barrier's part of the step's residual along that motion is  r = sum_pairs sum_i f_i . v_i.
#pragma once

#include <vector>

#include "adjoint/contact/area_weights_adjoint.hpp"
#include "adjoint/model_gradient.hpp"
#include "core/contact/contact_set.hpp"

namespace fettle::adjoint::contact {

/// Contacts of one configuration with what gives them meaning.
struct ContactsAtPose {
    const core::model::Model& model;
    const core::contact::ContactSet& contacts;
    const std::vector<core::kinematics::Pose>& poses;
    const core::contact::BarrierParameters& parameters;
    const core::contact::ContactAreas* areas = nullptr;  ///< of the same contacts, if the barrier is area-weighted
};

/// vertices_bar -= dr/dX and dmin_bar -= dr/ddmin for every seed s and body, with the motion lambda[s][body] = (dq, phi):
///   v_i = lambda_q + phi x R X_i,   dr/dX_i = R^T ((H v)_i - phi x f_i) + sum_j (df_j/deps . v_j) deps/dX_i.
/// Contacts are visited once, with all seeds inside.
/// @param areas_bar  [seed][body]: the areas' part is subtracted; irrelevant where nothing is area-weighted
void subtract_contact_vertices_adjoint(const ContactsAtPose& at, const std::vector<std::vector<Vector6>>& lambda,
                                       std::vector<ModelGradient>& model_bar, std::vector<std::vector<AreaChange>>& areas_bar);

/// dE/dP (3x4 per body) of the barrier, sum f_i [X_i; 1]^T, and its change.
struct PoseGradientTangent {
    std::vector<Matrix34> value, dot;  ///< [body]
};

/// Along poses_dot (3x4 per body, any matrices), vertices_dot (`direction`) and the areas' change; added to `out`.
void add_contact_gradient_tangent(const ContactsAtPose& at, const std::vector<Matrix34>& poses_dot, const ModelTangent& direction,
                                  const std::vector<AreaChange>& areas_dot, PoseGradientTangent& out);

}  // namespace fettle::adjoint::contact
