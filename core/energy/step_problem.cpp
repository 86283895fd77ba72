// SPDX-License-Identifier: MIT
#include "fettle/core/energy/step_problem.hpp"

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/parallel.hpp"

namespace fettle::core::energy {

using kinematics::Pose;

StepProblem step_problem(const model::Model& model, const History& history, double kappa) {
    StepProblem problem{integration_step(model, history), &model, history.poses, 0, {}, {}, {}, mechanism_step(model, history)};
    // Quasi-static steps know no rates.
    if (model.contact_damping_time > 0 && model.integrator != scene::Integrator::quasi_static)
        for (const Pose& pose : history.poses) problem.contact_damping.start.push_back(pose_matrix(pose));
    set_kappa(problem, kappa);
    return problem;
}

void set_end_time(StepProblem& problem, double time) { set_end_time(problem.model->mechanism, time, problem.mechanism); }

void set_kappa(StepProblem& problem, double kappa) {
    problem.kappa = kappa;
    problem.barrier = contact::barrier_parameters(problem.model->dhat, problem.model->dmin, kappa, problem.weight);
    if (problem.contact_damping.start.empty()) return;
    contact::set_contact_damping(problem.model->contact_damping_time / problem.model->timestep, problem.barrier, problem.contact_damping);
}

StepProblem implicit_euler_problem(const model::Model& model, std::vector<Pose> poses_t0, const std::vector<Matrix34>& velocities_t0) {
    FETTLE_ASSERT(model.integrator == scene::Integrator::implicit_euler, "another integrator is asked for");
    return step_problem(model, {std::move(poses_t0), velocities_t0, {}, {}, {}}, model.kappa);
}

std::vector<Pose> poses_of(const StepProblem& problem, const std::vector<kinematics::ChartPoint>& points) {
    constexpr int bodies_at_once = 64;  // that a thread takes
    std::vector<Pose> poses(points.size());
    base::parallel_for(count_of(points), bodies_at_once, [&](int i) { poses[i] = pose_of(problem, i, points[i]); });
    return poses;
}

Pose pose_of(const StepProblem& problem, int body, const kinematics::ChartPoint& point) {
    const Matrix3& start = problem.poses_t0[body].rotation;
    const Vector3& theta = point.rotation_vector;
    Pose pose;
    pose.position = point.position;
    pose.rotation = theta.isZero(0) ? start : kinematics::orthonormalised(kinematics::rotation(theta) * start);
    return pose;
}

bool has_free_dof(const model::Body& body) {
    for (int k = 0; k < 6; ++k)
        if (model::is_free(body, k)) return true;
    return false;
}

}  // namespace fettle::core::energy
