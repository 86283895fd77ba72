// SPDX-License-Identifier: MIT
/// First and second derivatives of functions of body poses, in tangent coordinates: a body moves by (dq, phi), R -> exp([phi]) R.
///
/// A potential that acts through body points x = R X + q is summed per body as two small quantities from which gradient and curvature
/// follow:
///   force  F = sum f_i              (f_i = dE/dx_i, world)
///   arm    S = sum f_i (x_i - q)^T  (3x3; equals (dE/dR) R^T)
/// gradient: dE/dq = F, dE/dphi = axial(S) = sum (x_i - q) x f_i. The curvature of the rotation itself contributes, in tangent coordinates
/// at R,
///   1/2 (S + S^T) - tr(S) I,
/// and in a chart theta (R = exp([theta]) base) the matrix sum_ij S_ij (d2R/dtheta_a dtheta_b R^T)_ij.
/// The rest of the Hessian (Gauss-Newton part, J^T H_x J) is summed in blocks.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/kinematics/rotation.hpp"

namespace fettle::core::kinematics {

struct PoseGradient {
    Vector3 force = Vector3::Zero();  ///< F [J/m]
    Matrix3 arm = Matrix3::Zero();    ///< S [J]
    void add_force(const Vector3& f, const Vector3& arm_vector) {
        force += f;
        arm += f * arm_vector.transpose();
    }
};

/// (dE/dq, dE/dphi).
inline Vector6 tangent_gradient(const PoseGradient& g) {
    const Matrix3& s = g.arm;
    Vector6 out;
    out << g.force, s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1);
    return out;
}

/// Curvature of the rotation in tangent coordinates, 1/2 (S + S^T) - tr(S) I.
inline Matrix3 tangent_curvature(const Matrix3& arm) { return 0.5 * (arm + arm.transpose()) - arm.trace() * Matrix3::Identity(); }

/// Curvature of the rotation in the chart: entry (a, b) = <S, d2R(theta)/dtheta_a dtheta_b R(theta)^T>.
inline Matrix3 chart_curvature(const Matrix3& arm, const Vector3& theta) { return rotation_curvature(arm * rotation(theta), theta); }

/// Off-diagonal 6x6 block of two bodies, a < b: rows of a, columns of b.
struct OffDiagonalBlock {
    int a = 0, b = 0;
    Matrix6 block = Matrix6::Zero();
};

/// Symmetric second derivative over all bodies' (q, phi) or (q, theta).
struct BlockHessian {
    std::vector<Matrix6> diagonal;               ///< [body]
    std::vector<OffDiagonalBlock> off_diagonal;  ///< sorted by (a, b), each pair once
};

}  // namespace fettle::core::kinematics
