// SPDX-License-Identifier: MIT
#include "core/scene/angles.hpp"

#include <cmath>
#include <numbers>

#include "core/kinematics/tangent_system.hpp"

namespace fettle::core::scene {
namespace {

struct SineCosine {
    double sine, cosine;
};

SineCosine sine_cosine(double degrees) {
    const double turned = std::remainder(degrees, 360.0);  // exact
    if (turned == 0) return {0, 1};
    if (turned == 90) return {1, 0};
    if (turned == -90) return {-1, 0};
    if (std::abs(turned) == 180) return {0, -1};
    return {std::sin(radians(turned)), std::cos(radians(turned))};
}

}  // namespace

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

Matrix3 rotation_of(const Orientation& orientation) {
    const Vector3& x = orientation.numbers;
    if (orientation.kind == Orientation::Kind::vector) return kinematics::rotation(x);
    using Eigen::AngleAxisd;
    return (AngleAxisd(x[2], Vector3::UnitZ()).toRotationMatrix() * AngleAxisd(x[1], Vector3::UnitY()).toRotationMatrix()) *
           AngleAxisd(x[0], Vector3::UnitX()).toRotationMatrix();
}

Matrix3 rotation_axes(const Orientation& orientation) {
    const Vector3& x = orientation.numbers;
    if (orientation.kind == Orientation::Kind::vector) return kinematics::left_jacobian(x);
    const Matrix3 about_z = Eigen::AngleAxisd(x[2], Vector3::UnitZ()).toRotationMatrix();
    const Matrix3 about_y = Eigen::AngleAxisd(x[1], Vector3::UnitY()).toRotationMatrix();
    Matrix3 axes;
    axes << about_z * about_y.col(0), about_z.col(1), Vector3::UnitZ();
    return axes;
}

Matrix3 rotation_from_degrees(const Vector3& angles) {
    const auto [sa, ca] = sine_cosine(angles.x());
    const auto [sb, cb] = sine_cosine(angles.y());
    const auto [sc, cc] = sine_cosine(angles.z());
    Matrix3 rx, ry, rz;
    rx << 1, 0, 0, 0, ca, -sa, 0, sa, ca;
    ry << cb, 0, sb, 0, 1, 0, -sb, 0, cb;
    rz << cc, -sc, 0, sc, cc, 0, 0, 0, 1;
    return rz * ry * rx;
}

}  // namespace fettle::core::scene
