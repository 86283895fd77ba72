// SPDX-License-Identifier: MIT
#include "core/energy/step_problem.hpp"

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"

namespace fettle::core::energy {

namespace {

std::vector<double> measures_at(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                                const std::vector<double>& angles) {
    const std::vector<measure::PlacedFrame> frames = placed(set.frames, poses);
    std::vector<double> out(set.measures.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = constraint::value_at(set, static_cast<int>(i), frames, angles);
    return out;
}

bool looks_back(const model::Mechanism& mechanism) {
    for (const model::MeasureTerm& term : mechanism.terms)
        if (term.kind == model::LawKind::damper || term.kind == model::LawKind::friction) return true;
    return false;
}

}  // namespace

std::vector<double> measure_rates(const measure::MeasureSet& set, const std::vector<kinematics::Pose>& poses,
                                  const std::vector<Matrix34>& velocities) {
    const std::vector<measure::PlacedFrame> frames = placed(set.frames, poses);
    std::vector<double> out(set.measures.size(), 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const measure::Measure& m = set.measures[i];
        const measure::PoseGradients g = pose_gradients(m, vector_function(m, frames), frames);
        for (const auto& [frame, gradient] : {std::pair(m.a, g.a), std::pair(m.b, g.b)}) {
            const int body = set.frames[frame].body;
            if (body == measure::world) continue;
            const auto k = static_cast<std::size_t>(body);
            const Matrix34& velocity = velocities[k];
            out[i] += gradient.force.dot(velocity.col(3)) + (gradient.arm * poses[k].rotation).cwiseProduct(velocity.leftCols<3>()).sum();
        }
    }
    return out;
}

MechanismStep mechanism_step(const model::Model& model, const History& history) {
    MechanismStep step;
    if (model.mechanism.empty()) return step;
    const measure::MeasureSet& set = model.mechanism.set;
    step.angles = history.angles.empty() ? constraint::angles_at(set, history.poses, {}) : history.angles;
    if (looks_back(model.mechanism)) {
        step.measures = measures_at(set, history.poses, step.angles);
        if (model.integrator == scene::Integrator::bdf2 && !history.poses_before.empty()) {
            std::vector<kinematics::Pose> before;
            for (const Matrix34& p : history.poses_before) before.push_back({p.leftCols<3>(), p.col(3)});
            const std::vector<double> earlier = measures_at(set, before, step.angles);
            for (std::size_t i = 0; i < earlier.size(); ++i) step.measures[i] = (4 * step.measures[i] - earlier[i]) / 3;
        }
        if (model.integrator == scene::Integrator::newmark) {
            const std::vector<double> rates = measure_rates(set, history.poses, history.velocities);
            for (std::size_t i = 0; i < rates.size(); ++i) step.measures[i] += 0.5 * model.timestep * rates[i];
        }
    }
    set_end_time(model.mechanism, 0, step);
    return step;
}

void set_end_time(const model::Mechanism& mechanism, double time, MechanismStep& step) {
    step.end_time = time;
    step.row_targets.resize(mechanism.rows.size());
    for (std::size_t i = 0; i < mechanism.rows.size(); ++i) step.row_targets[i] = target_at(mechanism.rows[i], time);
}

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
