// SPDX-License-Identifier: MIT
#include "design/quantities/marker.hpp"

namespace fettle::design::quantities {

Vector3 marker_position(const description::Simulated& s, int t, int body, const Vector3& point) {
    const Vector3 X = point - s.model.bodies[body].reference_point;
    return core::kinematics::world_position(s.trajectory.poses[t][body], X);
}

void add_marker_seed(const description::Simulated& s, int t, int body, const OwnPoint& point, const Vector3& gradient,
                     description::Seeds& seeds) {
    const Vector3 X = point.value(s) - s.model.bodies[body].reference_point;
    Matrix34& bar = seeds.trajectory_bar.pose_bar[t][body];
    bar.leftCols<3>() += gradient * X.transpose();
    bar.col(3) += gradient;
    point.add_seed(s, s.trajectory.poses[t][body].rotation.transpose() * gradient, seeds);
}

}  // namespace fettle::design::quantities
