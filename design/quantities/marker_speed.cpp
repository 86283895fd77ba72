// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/marker_speed.hpp"

#include "fettle/adjoint/stepper/velocities.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

Eigen::Vector4d MarkerSpeed::place(const core::model::Model& model) const {
    const Vector3 X = of_.point - model.bodies[of_.body].reference_point;
    return X.homogeneous();
}

std::vector<Vector3> MarkerSpeed::vectors(const Simulated& s) const {
    std::vector<Vector3> out;
    for (const std::vector<Matrix34>& at : adjoint::stepper::end_velocities(s.model, s.trajectory))
        out.emplace_back(at[of_.body] * place(s.model));
    return out;
}

void MarkerSpeed::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    for (size_t t = 0; t < weights.size(); ++t) {
        if (weights[t].isZero(0)) continue;
        const Matrix34 bar = weights[t] * place(s.model).transpose();
        adjoint::stepper::add_velocity_seed(s.model, static_cast<int>(t), of_.body, bar, seeds.trajectory_bar);
    }
}

Errors MarkerSpeed::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const core::base::Error& error : description::check_body(model, of_.body)) errors.push_back(error);
    if (model.integrator == core::scene::Integrator::quasi_static)
        errors.push_back({ErrorCode::inconsistent, "", "a quasi-static simulation has no velocities"});
    return errors;
}

}  // namespace fettle::design::quantities
