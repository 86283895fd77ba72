// SPDX-License-Identifier: MIT
/// The start of a model (core/model/mechanism_start.hpp) forwards: how assembled poses and agreed velocities change with what is written
/// and with the joints. Both are differentiated as what they are defined by, in 3 x 4 matrices: with G_i = dc_i/dP of a row
/// (adjoint/measure/measure_tangent.hpp) and V_k = [[e_phi] R, e_q] the unit motions,
///   assembly    <(P - P0) M + sum m_i G_i, V_k> = 0,   c_i(P) = target_i
///   velocities  <V_delta M + sum m_i G_i, V_k> = 0,    <G_i, V_u> = rate_i,   u = v + delta
/// and the matrices of both are those expressions' own changes, column by column, solved as they are by pivoting. No mass matrix, no row
/// Jacobian, no curvature and no saddle solver enters, so that agreement with mechanism_start_adjoint.hpp checks those. Cubic in the number
/// of coordinates: for checks and for small mechanisms.
#pragma once

#include "adjoint/model_gradient.hpp"

namespace fettle::adjoint::model {

/// Changes of what is written, per body.
struct WrittenStartTangent {
    std::vector<Vector6> pose;      ///< (q, phi) of the reference point's frame
    std::vector<Vector6> velocity;  ///< (v, omega)
    std::vector<Vector6> rate;      ///< of prescribed coordinates: how fast their curves begin
};

/// Changes of what the model starts with: of Body::pose_start, as (q, phi), and Body::velocity_start, entry by entry.
struct StartTangent {
    std::vector<Vector6> pose;
    std::vector<Matrix34> velocity;
};

/// @param direction  of mechanism, densities and vertices; of its starts no use is made.
/// Contract: as MechanismStartAdjoint.
StartTangent written_start_tangent(const core::model::Model& model, const WrittenStartTangent& written, const ModelTangent& direction);

}  // namespace fettle::adjoint::model
