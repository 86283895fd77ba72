// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/marker.hpp"

namespace fettle::design::quantities {

Vector3 marker_position(const description::Simulated& s, int t, int body, const Vector3& point) {
    const Vector3 X = point - s.model.bodies[static_cast<size_t>(body)].reference_point;
    return core::kinematics::world_position(s.trajectory.poses[static_cast<size_t>(t)][static_cast<size_t>(body)], X);
}

void add_marker_seed(const description::Simulated& s, int t, int body, const Vector3& point, const Vector3& gradient,
                     description::Seeds& seeds) {
    const Vector3 X = point - s.model.bodies[static_cast<size_t>(body)].reference_point;
    Matrix34& bar = seeds.trajectory_bar.pose_bar[static_cast<size_t>(t)][static_cast<size_t>(body)];
    bar.leftCols<3>() += gradient * X.transpose();
    bar.col(3) += gradient;
}

}  // namespace fettle::design::quantities
