// SPDX-License-Identifier: MIT
#include "core/kinematics/mass_matrix.hpp"

namespace fettle::core::kinematics {

Matrix6 mass_matrix(const Matrix3& rotation, const Matrix4& moments) {
    const Matrix3 second = rotation * moments.topLeftCorner<3, 3>() * rotation.transpose();
    const Matrix3 first = cross_matrix(rotation * moments.topRightCorner<3, 1>());
    Matrix6 h;
    h << moments(3, 3) * Matrix3::Identity(), -first, first, second.trace() * Matrix3::Identity() - second;
    return h;
}

}  // namespace fettle::core::kinematics
