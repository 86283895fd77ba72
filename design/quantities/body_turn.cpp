// SPDX-License-Identifier: MIT
#include "design/quantities/body_turn.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/measure/measure.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

std::vector<double> BodyTurn::series(const Simulated& s) const {
    const Vector3 x = axis_.unitOrthogonal(), y = axis_.cross(x);
    const Vector3 at_start = s.trajectory.poses[0][body_].rotation.transpose() * x;
    std::vector<double> out{0};
    double before = 0;
    for (size_t t = 1; t < s.trajectory.poses.size(); ++t) {
        const Vector3 u = s.trajectory.poses[t][body_].rotation * at_start;
        before = core::measure::nearest_turn(std::atan2(y.dot(u), x.dot(u)), before);
        out.push_back(before);
    }
    return out;
}

// d angle = g . du,  du = dR_t R_0^T x + R_t dR_0^T x.
void BodyTurn::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    const Vector3 x = axis_.unitOrthogonal(), y = axis_.cross(x);
    const Vector3 at_start = s.trajectory.poses[0][body_].rotation.transpose() * x;
    std::vector<std::vector<Matrix34>>& bar = seeds.trajectory_bar.pose_bar;
    for (size_t t = 1; t < weights.size(); ++t) {  // at the start the turn is 0, whatever the pose
        if (weights[t] == 0) continue;
        const Matrix3& rotation = s.trajectory.poses[t][body_].rotation;
        const Vector3 u = rotation * at_start;
        const double p = x.dot(u), q = y.dot(u);
        const Vector3 g = weights[t] / (p * p + q * q) * (p * y - q * x);
        bar[t][body_].leftCols<3>() += g * at_start.transpose();
        bar[0][body_].leftCols<3>() += x * (rotation.transpose() * g).transpose();
    }
}

Errors BodyTurn::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const core::base::Error& error : description::check_body(model, body_)) errors.push_back(error);
    return errors;
}

}  // namespace fettle::design::quantities
