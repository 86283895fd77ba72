// SPDX-License-Identifier: MIT
#include "design/urdf/robot.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::design::urdf {

Matrix3 rotation_of_rpy(const Vector3& rpy) {
    return (Eigen::AngleAxisd(rpy[2], Vector3::UnitZ()) * Eigen::AngleAxisd(rpy[1], Vector3::UnitY()) *
            Eigen::AngleAxisd(rpy[0], Vector3::UnitX()))
        .toRotationMatrix();
}

Vector3 rpy_of_rotation(const Matrix3& rotation) {
    const double level = std::hypot(rotation(0, 0), rotation(1, 0)), pitch = std::atan2(-rotation(2, 0), level);
    // Straight up or down only the sum or difference of the other two is there: yaw takes it.
    if (level < 1e-9) return {0, pitch, std::atan2(-rotation(0, 1), rotation(1, 1))};
    return {std::atan2(rotation(2, 1), rotation(2, 2)), pitch, std::atan2(rotation(1, 0), rotation(0, 0))};
}

core::kinematics::Pose motion_of(bool slides, const Vector3& axis, double coordinate) {
    const Vector3 along = axis.normalized();
    if (slides) return {Matrix3::Identity(), coordinate * along};
    return {Eigen::AngleAxisd(coordinate, along).toRotationMatrix(), Vector3::Zero()};
}

std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t most_named = 6;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i) text += (i == 0 ? "\"" : ", \"") + names[i] + "\"";
    return names.size() <= most_named ? text : text + " and " + std::to_string(names.size() - most_named) + " more";
}

}  // namespace fettle::design::urdf
