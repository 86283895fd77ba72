// SPDX-License-Identifier: MIT
#include "fettle/core/stepper/step_outputs.hpp"

#include "fettle/core/energy/inertia.hpp"
#include "fettle/core/energy/loads.hpp"
#include "fettle/core/solver/newton.hpp"

namespace fettle::core::stepper {
namespace {

using kinematics::Pose;

// The solver leaves out the inertia and loads of bodies that it does not solve for. (Quasi-static steps have no inertia.)
Vector6 inertia_if_held(const energy::StepProblem& problem, std::size_t i, const kinematics::ChartPoint& point, const Pose& pose) {
    const model::Body& body = problem.model->bodies[i];
    bool held = body.moments(3, 3) > 0;
    for (int k = 0; k < 6; ++k) held = held && !is_free(body, k);
    if (!held) return Vector6::Zero();
    kinematics::PoseGradient gradient;
    if (problem.model->integrator == scene::Integrator::quasi_static)
        energy::add_gravity_gradient(problem, i, pose, gradient);
    else
        energy::add_inertia_gradient(pose, problem.pose_hat[i], body.moments, gradient);
    Vector6 out = tangent_gradient(gradient);
    out.head<3>() -= problem.weight * body.force;
    out.tail<3>() = kinematics::left_jacobian(point.rotation_vector).transpose() * out.tail<3>();
    return out;
}

// The residual of the prescribed coordinates is what the drive supplies; in world axes, out of the chart's.
std::vector<DriveForce> drive_forces(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved) {
    const auto& points = solved.path.back();
    const energy::ChartDerivatives d =
        energy::chart_derivatives(problem, points, solved.poses, solved.contacts, contact::HessianKind::projected);
    std::vector<DriveForce> out;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const model::Body& body = model.bodies[i];
        Vector6 residual = (d.gradient[i] + inertia_if_held(problem, i, points[i], solved.poses[i])) / problem.weight;
        for (int k = 0; k < 6; ++k)
            if (is_free(body, k)) residual[k] = 0;
        if (residual.isZero(0)) continue;
        const Vector3& theta = points[i].rotation_vector;
        out.push_back(
            {static_cast<int>(i), residual.head<3>(), kinematics::left_jacobian(theta).transpose().inverse() * residual.tail<3>()});
    }
    return out;
}

}  // namespace

StepOutputs step_outputs(const model::Model& model, const energy::StepProblem& problem, const solver::NewtonResult& solved,
                         const StepState& end) {
    energy::StepProblem last = problem;
    last.friction = solved.friction;
    StepOutputs out;
    static_cast<energy::TermReport&>(out) = energy::term_report({last, solved.poses, solved.contacts, end.history});
    out.time = end.time;
    out.kappa = problem.kappa;
    out.drives = drive_forces(model, last, solved);
    if (!model.mechanism.empty()) out.joints = joint_forces(last, solved.poses, solved.multipliers);
    return out;
}

}  // namespace fettle::core::stepper
