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

std::vector<Vector3> ContactForce::vectors(const Simulated& s) const {
    return adjoint::stepper::contact_forces(s.model, s.trajectory, asked_of(s.model, of_));
}

void ContactForce::add_vector_seeds(const Simulated& s, const std::vector<Vector3>& weights, Seeds& seeds) const {
    adjoint::stepper::add_contact_force_seeds(s.model, s.trajectory, asked_of(s.model, of_), weights, seeds);
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
