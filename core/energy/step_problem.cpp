// SPDX-License-Identifier: MIT
#include "fettle/core/energy/step_problem.hpp"

#include "fettle/core/base/contract.hpp"

namespace fettle::core::energy {

using kinematics::Pose;

StepProblem step_problem(const model::Model& model, const History& history, double kappa) {
    StepProblem problem{integration_step(model, history), &model, history.poses, 0, {}, {}};
    set_kappa(problem, kappa);
    return problem;
}

void set_kappa(StepProblem& problem, double kappa) {
    problem.kappa = kappa;
    problem.barrier = contact::barrier_parameters(problem.model->dhat, problem.model->dmin, kappa, problem.weight);
}

StepProblem implicit_euler_problem(const model::Model& model, std::vector<Pose> poses_t0, const std::vector<Matrix34>& velocities_t0) {
    FETTLE_ASSERT(model.integrator == scene::Integrator::implicit_euler, "another integrator is asked for");
    return step_problem(model, {std::move(poses_t0), velocities_t0, {}, {}, {}}, model.kappa);
}

std::vector<Pose> poses_of(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points) {
    std::vector<Pose> poses(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        poses[i] = {kinematics::rotation(points[i].rotation_vector) * problem.poses_t0[i].rotation, points[i].position};
    return poses;
}

bool has_free_dof(const model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (model::is_free(body, k)) return true;
    return false;
}

}  // namespace fettle::core::energy
