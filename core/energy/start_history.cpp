// SPDX-License-Identifier: MIT
#include "core/energy/start_history.hpp"

#include "core/energy/measure_terms.hpp"

namespace fettle::core::energy {

StepProblem start_problem(const model::Model& model) {
    History start;
    StepProblem problem;
    problem.model = &model;
    problem.weight = 1;
    problem.slip_time = 0.5 * model.timestep;
    problem.damping_weight = 1 / problem.slip_time;
    for (const model::Body& body : model.bodies) {
        start.poses.push_back(body.pose_start);
        start.velocities.emplace_back(-body.velocity_start);  // Newmark's m_slip is m + slip_time times its rate
        problem.slip_reference.emplace_back(pose_matrix(body.pose_start) - problem.slip_time * body.velocity_start);
    }
    start.angles = model.mechanism.angles_start;
    problem.mechanism = mechanism_step(model, start);
    problem.poses_t0 = std::move(start.poses);
    return problem;
}

std::vector<Vector6> start_loads(const model::Model& model) {
    std::vector<Vector6> loads;
    for (const model::Body& body : model.bodies) {
        loads.emplace_back();
        loads.back() << body.force, body.torque;
    }
    if (model.mechanism.terms.empty()) return loads;
    const StepProblem problem = start_problem(model);
    CouplingDerivatives d(loads.size());
    const contact::ContactSet none;
    measure_terms.add_derivatives({problem, problem.poses_t0, none, contact::HessianKind::exact}, d);
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i] -= tangent_gradient(d.gradient[i]);
    return loads;
}

History start_history(const model::Model& model) {
    History history;
    history.angles = model.mechanism.angles_start;
    for (const model::Body& body : model.bodies) {
        history.poses.push_back(body.pose_start);
        history.velocities.push_back(body.velocity_start);
    }
    if (model.integrator != scene::Integrator::newmark) return history;
    const std::vector<Vector6> loads = start_loads(model);
    for (std::size_t i = 0; i < loads.size(); ++i)
        history.accelerations.push_back(start_acceleration(model.bodies[i], model.gravity, loads[i]));
    return history;
}

}  // namespace fettle::core::energy
