// SPDX-License-Identifier: MIT
#include "fettle/design/objectives/objective.hpp"

namespace fettle::design::objectives {

Seeds zero_seeds(const Simulated& s) {
    const int steps = static_cast<int>(s.trajectory.steps.size());
    return {adjoint::zero_trajectory_gradient(steps, static_cast<int>(s.model.bodies.size())),
            adjoint::zero_model_gradient(s.model, steps)};
}

Vector3 marker_position(const Simulated& s, int t, int body, const Vector3& point) {
    const Vector3 X = point - s.model.bodies[static_cast<size_t>(body)].reference_point;
    return core::kinematics::world_position(s.trajectory.poses[static_cast<size_t>(t)][static_cast<size_t>(body)], X);
}

void add_marker_seed(const Simulated& s, int t, int body, const Vector3& point, const Vector3& gradient, Seeds& seeds) {
    const Vector3 X = point - s.model.bodies[static_cast<size_t>(body)].reference_point;
    Matrix34& bar = seeds.trajectory_bar.pose_bar[static_cast<size_t>(t)][static_cast<size_t>(body)];
    bar.leftCols<3>() += gradient * X.transpose();
    bar.col(3) += gradient;
}

}  // namespace fettle::design::objectives
