// SPDX-License-Identifier: MIT
#include "adjoint/energy/start_history_adjoint.hpp"

#include "adjoint/energy/measure_terms_adjoint.hpp"
#include "adjoint/energy/time_integration_adjoint.hpp"
#include "core/energy/measure_terms.hpp"
#include "core/energy/start_history.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::adjoint::energy {
namespace {

using core::kinematics::Pose;
using core::model::Model;

Matrix34 entries_of(const Vector6& gradient, const Matrix3& rotation) {
    Matrix34 out;
    out << 0.5 * cross_matrix(gradient.tail<3>()) * rotation, gradient.head<3>();
    return out;
}

// The mechanism's terms at the start.
class StartTerms {
public:
    explicit StartTerms(const Model& model) : problem_(core::energy::start_problem(model)) {}

    const core::energy::StepProblem& problem() const { return problem_; }
    const std::vector<Pose>& poses() const { return problem_.poses_t0; }
    StepEnd end() const { return {{problem_, problem_.poses_t0, none_, core::contact::HessianKind::exact}, nullptr}; }

    core::energy::CouplingDerivatives derivatives() const {
        core::energy::CouplingDerivatives d(poses().size());
        core::energy::measure_terms.add_derivatives(end(), d);
        return d;
    }

private:
    core::energy::StepProblem problem_;
    core::contact::ContactSet none_;
};

// The change of the terms' gradients, (force, torque) per body.
std::vector<Vector6> gradients_tangent(const Model& model, const StartDirection& direction) {
    const std::size_t n = model.bodies.size();
    std::vector<Vector6> out(n, Vector6::Zero());
    if (model.mechanism.terms.empty()) return out;
    const StartTerms terms(model);
    std::vector<Matrix34> slip_dot = direction.poses_dot;
    for (std::size_t i = 0; i < n; ++i) slip_dot[i] -= terms.problem().slip_time * direction.model.bodies[i].velocity_start_dot;
    const std::vector<Matrix34> zero(n, Matrix34::Zero());
    contact::PoseGradientTangent energy{zero, zero};
    measure_terms_adjoint.add_tangent(terms.end(),
                                      {direction.poses_dot, zero, slip_dot, direction.poses_dot, zero, direction.moments_dot, {}, zero},
                                      direction.model, energy);
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix3 turned = energy.dot[i].leftCols<3>() * terms.poses()[i].rotation.transpose() +
                               energy.value[i].leftCols<3>() * direction.poses_dot[i].leftCols<3>().transpose();
        out[i] << energy.dot[i].col(3), turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1);
    }
    return out;
}

// Subtracts the derivative of the terms' gradient along the motions.
void subtract_terms(const Model& model, const std::vector<std::vector<Vector6>>& motion, const StartGradient& to) {
    if (model.mechanism.terms.empty()) return;
    const StartTerms terms(model);
    const std::size_t n = model.bodies.size();
    StepGradient step_bar;
    step_bar.start_bar.assign(motion.size(), std::vector<Matrix34>(n, Matrix34::Zero()));
    step_bar.slip_reference_bar = step_bar.start_bar;
    measure_terms_adjoint.subtract_reverse(terms.end(), motion, step_bar, to.model_bar);
    const core::energy::CouplingDerivatives d = terms.derivatives();
    for (std::size_t s = 0; s < motion.size(); ++s) {
        const std::vector<Vector6> along = core::linear::multiply(d.hessian, motion[s]);
        for (std::size_t i = 0; i < n; ++i) {
            const Matrix3& rotation = terms.poses()[i].rotation;
            const Matrix34& slip_bar = step_bar.slip_reference_bar[s][i];
            Matrix34& bar = to.poses_bar[s][i];
            bar += step_bar.start_bar[s][i] + slip_bar - entries_of(along[i], rotation);
            bar.leftCols<3>() -= cross_matrix(motion[s][i].tail<3>()).transpose() * d.gradient[i].arm * rotation;
            to.model_bar[s].bodies[i].velocity_start_bar -= terms.problem().slip_time * slip_bar;
        }
    }
}

}  // namespace

std::vector<Matrix34> start_accelerations_tangent(const Model& model, const StartDirection& direction) {
    const std::vector<Vector6> loads = core::energy::start_loads(model), of_terms = gradients_tangent(model, direction);
    std::vector<Matrix34> out(loads.size(), Matrix34::Zero());
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!core::energy::has_free_dof(model.bodies[i])) continue;
        const BodyTangent& dot = direction.model.bodies[i];
        StartChange change;
        change.velocity = dot.velocity_start_dot;
        change.rotation = direction.poses_dot[i].leftCols<3>();
        change.gravity = direction.model.gravity_dot;
        change.loads << dot.force_dot, dot.torque_dot;
        change.loads -= of_terms[i];
        change.moments = direction.moments_dot[i];
        out[i] = start_acceleration_tangent({model.bodies[i], model.gravity, loads[i]}, change);
    }
    return out;
}

void start_accelerations_adjoint(const Model& model, const std::vector<std::vector<Matrix34>>& bar, const StartGradient& to) {
    const std::vector<Vector6> loads = core::energy::start_loads(model);
    std::vector<std::vector<Vector6>> motion(bar.size(), std::vector<Vector6>(loads.size(), Vector6::Zero()));
    for (std::size_t i = 0; i < loads.size(); ++i) {
        if (!core::energy::has_free_dof(model.bodies[i])) continue;
        for (std::size_t s = 0; s < bar.size(); ++s) {
            const StartChange start = start_acceleration_adjoint({model.bodies[i], model.gravity, loads[i]}, bar[s][i]);
            BodyGradient& body_bar = to.model_bar[s].bodies[i];
            body_bar.velocity_start_bar += start.velocity;
            body_bar.force_bar += start.loads.head<3>();
            body_bar.torque_bar += start.loads.tail<3>();
            to.poses_bar[s][i].leftCols<3>() += start.rotation;
            to.moments_bar[s][i] += start.moments;
            to.model_bar[s].gravity_bar += start.gravity;
            motion[s][i] = start.loads;
        }
    }
    subtract_terms(model, motion, to);
}

}  // namespace fettle::adjoint::energy
