// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/contact_force.hpp"

#include "fettle/adjoint/stepper/contact_forces.hpp"

namespace fettle::design::quantities {

using description::Seeds;
using description::Simulated;

namespace {

adjoint::stepper::ContactForceOf asked_of(const core::model::Model& model, const ContactForce::Of& of) {
    adjoint::stepper::ContactForceOf out{of.body, of.other};
    if (of.about) out.about = *of.about - model.bodies[of.body].reference_point;
    return out;
}

}  // namespace

std::vector<Vector3> ContactForce::loads(const Simulated& s) const {
    return adjoint::stepper::contact_forces(s.model, s.trajectory, asked_of(s.model, of_));
}

std::vector<double> ContactForce::series(const Simulated& s) const {
    std::vector<double> out;
    for (const Vector3& load : loads(s)) out.push_back(of_.axis.isZero(0) ? load.norm() : of_.axis.dot(load));
    return out;
}

void ContactForce::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    std::vector<Vector3> along(weights.size(), of_.axis);
    if (of_.axis.isZero(0)) {
        const std::vector<Vector3> at = loads(s);
        for (size_t t = 0; t < along.size(); ++t) along[t] = at[t].isZero(0) ? Vector3(Vector3::Zero()) : at[t].normalized();
    }
    for (size_t t = 0; t < along.size(); ++t) along[t] *= weights[t];
    adjoint::stepper::add_contact_force_seeds(s.model, s.trajectory, asked_of(s.model, of_), along, seeds);
}

Errors ContactForce::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    for (const int body : {of_.body, of_.other.value_or(of_.body)})
        for (const core::base::Error& error : description::check_body(model, body)) errors.push_back(error);
    if (!errors.empty()) return errors;
    bool touches = false;
    for (int other = 0; other < count_of(model.bodies); ++other)
        touches = touches || ((!of_.other || other == *of_.other) && may_collide(model, of_.body, other));
    if (!touches)
        errors.push_back(
            {ErrorCode::inconsistent, "",
             "\"" + model.bodies[of_.body].name +
                 (of_.other ? "\" and \"" + model.bodies[*of_.other].name + "\" never collide" : std::string("\" collides with nothing"))});
    return errors;
}

}  // namespace fettle::design::quantities
