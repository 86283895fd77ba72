// SPDX-License-Identifier: MIT
/// Linear algebra vocabulary of the whole project. Column-major, double precision, SI units unless a name says otherwise.
/// `fettle::core::base` is the one namespace that every other folder sees unqualified (see the bottom of this file).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fettle::core::base {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using VectorX = Eigen::VectorXd;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Matrix4 = Eigen::Matrix4d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Matrix34 = Eigen::Matrix<double, 3, 4>;
using Matrix3X = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using MatrixX = Eigen::MatrixXd;

/// Bodies, vertices, steps and all else that is counted are indexed by `int`; how many a container has, as one.
template <class Container>
int count_of(const Container& container) {
    return static_cast<int>(container.size());
}

/// Cross-product matrix: cross_matrix(a) * b = a x b.
inline Matrix3 cross_matrix(const Vector3& a) {
    Matrix3 m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

}  // namespace fettle::core::base

namespace fettle {
using namespace core::base;  // base is the vocabulary of every layer
}
