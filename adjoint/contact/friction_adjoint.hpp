// SPDX-License-Identifier: MIT
/// Friction's forces (core/contact/friction.hpp), differentiated in what a solve holds constant: the poses and shapes from which normal
/// forces, tangents and material points were taken (the lag), the slip references, and the coefficients; reverse and forward.
///
/// A contact's part of the step's residual along a motion V = dP (3 x 4 per body) does not depend on which two tangents were chosen. With
/// n the normal of the lag, lambda its normal force, p_a, p_b the material points in their bodies' frames, e = [p; 1]:
///   m = (P_a - P_slip,a) e_a - (P_b - P_slip,b) e_b,   s = (1 - n n^T) m,   nu = V_a e_a - V_b e_b,
///   r = F . nu,   F = mu lambda f0'(|s|)/|s| s.
/// Derivatives of the lag, with r = sum w_i x_i the difference of the closest points at distance d, and interior parameters beta
/// (geometry/distance.hpp):
///   A_a . dx = r_a . sum w_i dx_i + r . sum w'_a,i dx_i,   K dbeta = -A . dx,   dw_i = sum_a w'_a,i dbeta_a,
///   dp_a = sum (w_i dX_i + dw_i X_i),   dn = (1 - n n^T) (sum w_i dx_i + sum_a r_a dbeta_a) / d,
///   lambda = -2 factor w m(c, eps) b'(d^2 - dmin^2) d,   which depends on dmin too (contact_pair_adjoint.hpp).
/// A contact's weight w is a multiplicity, which is constant, or follows from the areas (area_weights_adjoint.hpp): dlambda/dw = lambda/w.
/// Derivatives are those of the features that were closest.
#pragma once

#include <vector>

#include "adjoint/contact/contact_set_adjoint.hpp"

namespace fettle::adjoint::contact {

/// A configuration and its contacts, of which friction was taken.
struct LaggedContacts {
    std::vector<core::kinematics::Pose> poses;
    core::contact::ContactSet contacts;
    core::contact::ContactAreas areas;  ///< of the contacts, if the barrier is area-weighted
};

/// Friction with that lag, acting at other poses.
struct FrictionAtPose {
    const core::model::Model& model;
    const LaggedContacts& lag;
    const std::vector<core::kinematics::Pose>& poses;
    const std::vector<Matrix34>& slip_reference;
    const core::contact::BarrierParameters& parameters;  ///< of the barrier whose forces are the normal forces
    double slip_bound = 0;                               ///< e = eps_v slip_time [m]
};

/// What is subtracted from, by seed.
struct FrictionAdjoint {
    std::vector<std::vector<Matrix34>>& slip_reference_bar;
    std::vector<std::vector<Matrix34>>& lag_poses_bar;
    std::vector<std::vector<AreaChange>>& areas_bar;  ///< irrelevant where nothing is area-weighted
    std::vector<ModelGradient>& model_bar;            ///< vertices, coefficients, dmin
};

/// Subtracts dr/d(lag, slip references, vertices, coefficients) for every seed s, with the motion lambda[s][body] = (dq, phi).
void subtract_friction_adjoint(const FrictionAtPose& at, const std::vector<std::vector<Vector6>>& lambda, const FrictionAdjoint& bar);

/// Changes, 3 x 4 per body, any matrices.
struct FrictionTangent {
    const std::vector<Matrix34>& poses_dot;
    const std::vector<Matrix34>& slip_reference_dot;
    const std::vector<Matrix34>& lag_poses_dot;
    const std::vector<AreaChange>& areas_dot;
};

/// Adds dE/dP (3 x 4 per body) of friction and its change along these and `direction`.
void add_friction_tangent(const FrictionAtPose& at, const FrictionTangent& dot, const ModelTangent& direction, PoseGradientTangent& out);

}  // namespace fettle::adjoint::contact
