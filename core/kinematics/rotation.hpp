// SPDX-License-Identifier: MIT
/// Rotation vectors: value, first and second derivatives, left Jacobian, logarithm. docs/method/kinematics.md.
///   R(theta) = exp([theta]) = I + sinc(x) [theta] + 1/2 sinc(x/2)^2 [theta]^2,   x = |theta|
/// All derivatives are analytic and good to 1e-14 relative for |theta| in [0, 4 pi], near 0 and near 2 pi k too.
#pragma once

#include <array>

#include "core/base/types.hpp"

namespace fettle::core::kinematics {

/// sin(x)/x; its g = sinc'(x)/x; and h = g'(x)/x (all even, analytic at 0: 1, -1/3, 1/15).
double sinc(double x);
double sinc_g(double x);
double sinc_h(double x);

/// exp([theta]).
Matrix3 rotation(const Vector3& theta);

struct RotationDerivatives {
    Matrix3 value;                    ///< R(theta)
    std::array<Matrix3, 3> gradient;  ///< dR/dtheta_a
    std::array<Matrix3, 6> hessian;   ///< d2R/dtheta_a dtheta_b for (a,b) = 00, 01, 02, 11, 12, 22
};
RotationDerivatives rotation_derivatives(const Vector3& theta);

/// C with  C_ab = <s, d2R/dtheta_a dtheta_b>  (sum over the entries): without the second derivatives themselves, at a tenth of their cost.
Matrix3 rotation_curvature(const Matrix3& s, const Vector3& theta);

/// J with  dR(theta) = [J dtheta] R(theta)   (left Jacobian of SO(3)); identity at 0, singular at |theta| = 2 pi k, k >= 1.
Matrix3 left_jacobian(const Vector3& theta);

/// Its inverse. Contract: |theta| < 2 pi.
Matrix3 left_jacobian_inverse(const Vector3& theta);

/// Rotation vector with |theta| <= pi of a rotation matrix (orthonormal to about 1e-6; the nearest rotation is used).
Vector3 rotation_vector(const Matrix3& rotation);

/// The shortest turn that takes one direction to another, good to 1e-15 over the length of the sum of the two unit vectors; of directions
/// that are opposite to 1e-8, a half turn about an axis that is normal to the first. Contract: neither is zero.
Eigen::Quaterniond turn_between(const Vector3& from, const Vector3& to);

/// One Newton step towards the nearest rotation, R (3 I - R^T R) / 2: keeps a product of many rotations orthonormal.
Matrix3 orthonormalised(const Matrix3& nearly_a_rotation);

}  // namespace fettle::core::kinematics
