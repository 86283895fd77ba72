// SPDX-License-Identifier: MIT
#include "fettle/design/urdf/robot.hpp"

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

}  // namespace fettle::design::urdf
