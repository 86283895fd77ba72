// SPDX-License-Identifier: MIT
#include "fettle/core/energy/inertia.hpp"

namespace fettle::core::energy {

double inertia_potential(const Matrix34& pose, const Matrix34& pose_hat, const Matrix4& moments) {
    const Matrix34 d = pose - pose_hat;
    return 0.5 * (d * moments).cwiseProduct(d).sum();
}

void add_inertia_gradient(const kinematics::Pose& pose, const Matrix34& pose_hat, const Matrix4& moments,
                          kinematics::PoseGradient& gradient) {
    const Matrix34 g = (pose_matrix(pose) - pose_hat) * moments;
    gradient.force += g.col(3);
    gradient.arm += g.leftCols<3>() * pose.rotation.transpose();
}

Matrix6 inertia_hessian(const Matrix3& rotation, const Matrix4& moments) {
    const Matrix3 second = rotation * moments.topLeftCorner<3, 3>() * rotation.transpose();
    const Matrix3 first = cross_matrix(rotation * moments.topRightCorner<3, 1>());
    Matrix6 h;
    h << moments(3, 3) * Matrix3::Identity(), -first, first, second.trace() * Matrix3::Identity() - second;
    return h;
}

Matrix34 implicit_euler_pose_hat(const Matrix34& pose_t0, const Matrix34& velocity_t0, const Vector3& acceleration, double h) {
    Matrix34 hat = pose_t0 + h * velocity_t0;
    hat.col(3) += h * h * acceleration;
    return hat;
}

}  // namespace fettle::core::energy
