// SPDX-License-Identifier: MIT
#include "design/quantities/marker_speed.hpp"

#include "adjoint/stepper/velocities.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

Eigen::Vector4d MarkerSpeed::place(const Simulated& s) const {
    const Vector3 X = of_.point.value(s) - s.model.bodies[of_.body].reference_point;
    return X.homogeneous();
}

std::vector<Vector3> MarkerSpeed::vectors(const Simulated& s) const {
    std::vector<Vector3> out;
    const Eigen::Vector4d point = place(s);
    for (const std::vector<Matrix34>& at : adjoint::stepper::end_velocities(s.model, s.trajectory)) out.emplace_back(at[of_.body] * point);
    return out;
}

void MarkerSpeed::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    const Eigen::Vector4d point = place(s);
    for (size_t t = 0; t < weights.size(); ++t) {
        if (weights[t].isZero(0)) continue;
        const Matrix34 bar = weights[t] * point.transpose();
        adjoint::stepper::add_velocity_seed(s.model, static_cast<int>(t), of_.body, bar, seeds.trajectory_bar);
    }
    if (!of_.point.follows()) return;
    const auto velocities = adjoint::stepper::end_velocities(s.model, s.trajectory);
    Vector3 of_point = Vector3::Zero();
    for (size_t t = 0; t < weights.size(); ++t) of_point += velocities[t][of_.body].leftCols<3>().transpose() * weights[t];
    of_.point.add_seed(s, of_point, seeds);
}

std::vector<std::string> MarkerSpeed::parameters() const {
    std::vector<std::string> names;
    of_.point.add_parameters(names);
    return names;
}

Errors MarkerSpeed::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const core::base::Error& error : description::check_body(model, of_.body)) errors.push_back(error);
    if (model.integrator == core::scene::Integrator::quasi_static)
        errors.push_back({ErrorCode::inconsistent, "", "a quasi-static simulation has no velocities"});
    return errors;
}

}  // namespace fettle::design::quantities
