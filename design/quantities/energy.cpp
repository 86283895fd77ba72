// SPDX-License-Identifier: MIT
#include "design/quantities/energy.hpp"

#include "adjoint/model/body_mass_adjoint.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "adjoint/stepper/velocities.hpp"
#include "core/energy/measure_terms.hpp"

namespace fettle::design::quantities {

namespace {

using core::energy::LawValue;
using core::kinematics::pose_matrix;
using core::measure::Measure;
using core::model::Body;
using core::model::LawKind;
using core::model::MeasureTerm;
using core::model::Mechanism;
using description::Seeds;
using description::Simulated;

bool stores(const MeasureTerm& term) { return term.kind == LawKind::spring || term.kind == LawKind::stop; }

bool has_mass(const Body& body) { return body.moments(3, 3) > 0; }

// Springs and stops with the potential's own weight.
core::energy::StepProblem unweighted(const core::model::Model& model) {
    core::energy::StepProblem problem;
    problem.model = &model;
    problem.weight = 1;
    return problem;
}

double kinetic(const Simulated& s, const std::vector<Matrix34>& velocities) {
    double sum = 0;
    for (size_t i = 0; i < s.model.bodies.size(); ++i) {
        if (!has_mass(s.model.bodies[i])) continue;
        const Matrix34& v = velocities[i];
        sum += 0.5 * (v * s.model.bodies[i].moments).cwiseProduct(v).sum();
    }
    return sum;
}

double potential(const Simulated& s, size_t t) {
    double sum = 0;
    for (size_t i = 0; i < s.model.bodies.size(); ++i) {
        const Body& body = s.model.bodies[i];
        if (!has_mass(body)) continue;
        const Matrix34 pose = pose_matrix(s.trajectory.poses[t][i]);
        sum -= s.model.gravity.dot(pose * body.moments.col(3)) + body.force.dot(pose.col(3));
    }
    return sum;
}

double spring(const Simulated& s, size_t t, const std::vector<double>& angles) {
    const Mechanism& mechanism = s.model.mechanism;
    const std::vector<core::measure::PlacedFrame> frames = placed(mechanism.set.frames, s.trajectory.poses[t]);
    const core::energy::StepProblem problem = unweighted(s.model);
    double sum = 0;
    for (const MeasureTerm& term : mechanism.terms)
        if (stores(term)) sum += measure_law(problem, term, core::constraint::value_at(mechanism.set, term.measure, frames, angles)).value;
    return sum;
}

// Adds the seeds of scale times each, of the start (t = 0) or the end of step t.
class EnergySeeds {
public:
    EnergySeeds(const Simulated& s, size_t t, double scale, Seeds& seeds)
        : s_(s), t_(t), scale_(scale), seeds_(seeds), moments_bar_(s.model.bodies.size(), Matrix4::Zero()) {}

    void add_kinetic(const std::vector<Matrix34>& velocities) {
        for (size_t i = 0; i < s_.model.bodies.size(); ++i) {
            if (!has_mass(s_.model.bodies[i])) continue;
            const Matrix34 &v = velocities[i], bar = scale_ * v * s_.model.bodies[i].moments;
            adjoint::stepper::add_velocity_seed(s_.model, static_cast<int>(t_) - 1, static_cast<int>(i), bar, seeds_.trajectory_bar);
            moments_bar_[i] += 0.5 * scale_ * v.transpose() * v;
        }
    }

    void add_potential() {
        for (size_t i = 0; i < s_.model.bodies.size(); ++i) {
            const Body& body = s_.model.bodies[i];
            if (!has_mass(body)) continue;
            const Matrix34 pose = pose_matrix(s_.trajectory.poses[t_][i]);
            Matrix34& bar = seeds_.trajectory_bar.pose_bar[t_][i];
            bar -= scale_ * s_.model.gravity * body.moments.col(3).transpose();
            bar.col(3) -= scale_ * body.force;
            seeds_.model_bar.gravity_bar -= scale_ * pose * body.moments.col(3);
            seeds_.model_bar.bodies[i].force_bar -= scale_ * pose.col(3);
            const Eigen::Vector4d first = -0.5 * scale_ * pose.transpose() * s_.model.gravity;
            moments_bar_[i].col(3) += first;
            moments_bar_[i].row(3) += first.transpose();
        }
    }

    void add_spring(const std::vector<double>& angles) {
        const Mechanism& mechanism = s_.model.mechanism;
        const std::vector<core::kinematics::Pose>& poses = s_.trajectory.poses[t_];
        const std::vector<core::measure::PlacedFrame> frames = placed(mechanism.set.frames, poses);
        std::vector<Matrix3> rotations;
        for (const core::measure::Frame& f : mechanism.set.frames)
            rotations.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : poses[f.body].rotation);
        adjoint::MechanismGradient& bar = seeds_.model_bar.mechanism;
        for (size_t k = 0; k < mechanism.terms.size(); ++k) {
            const MeasureTerm& term = mechanism.terms[k];
            if (!stores(term)) continue;
            const Measure& m = mechanism.set.measures[term.measure];
            const core::measure::VectorFunction f = vector_function(m, frames);
            const LawValue law =
                measure_law(unweighted(s_.model), term, core::constraint::value_at(mechanism.set, term.measure, frames, angles));
            const core::measure::PoseGradients g = pose_gradients(m, f, frames);
            add_pose(mechanism, m.a, scale_ * law.first * tangent_gradient(g.a));
            add_pose(mechanism, m.b, scale_ * law.first * tangent_gradient(g.b));
            add_placement_gradient(f, scale_ * law.first, rotations, bar.frames);
            bar.term_coefficient[k] += scale_ * law.value / term.coefficient;
            bar.term_reference[k] -= scale_ * law.first;
        }
    }

    void finish() {
        for (size_t i = 0; i < moments_bar_.size(); ++i)
            adjoint::model::mass_moments_adjoint(s_.model.bodies[i], s_.model.dhat, moments_bar_[i], seeds_.model_bar.bodies[i]);
    }

private:
    void add_pose(const Mechanism& mechanism, int frame, const Vector6& gradient) {
        const int body = mechanism.set.frames[frame].body;
        if (body == core::measure::world) return;
        const auto i = static_cast<size_t>(body);
        seeds_.trajectory_bar.pose_bar[t_][i] += pose_entries(gradient, s_.trajectory.poses[t_][i].rotation);
    }

    const Simulated& s_;
    size_t t_;
    double scale_;
    Seeds& seeds_;
    std::vector<Matrix4> moments_bar_;
};

}  // namespace

bool Energy::has_kinetic(const core::model::Model& model) const {
    return has(EnergyKind::kinetic) && model.integrator != core::scene::Integrator::quasi_static;
}

std::vector<double> Energy::series(const Simulated& s) const {
    const std::vector<std::vector<double>> angles = adjoint::stepper::angles_along(s.model, s.trajectory);
    std::vector<std::vector<Matrix34>> velocities;
    if (has_kinetic(s.model)) velocities = adjoint::stepper::end_velocities(s.model, s.trajectory);
    std::vector<double> out;
    for (auto t = static_cast<size_t>(first_instant()); t < s.trajectory.poses.size(); ++t) {
        double sum = 0;
        if (has_kinetic(s.model)) sum += kinetic(s, velocities[t - 1]);
        if (has(EnergyKind::potential)) sum += potential(s, t);
        if (has(EnergyKind::spring)) sum += spring(s, t, angles[t]);
        out.push_back(sum);
    }
    return out;
}

void Energy::add_series_seeds(const Simulated& s, const std::vector<double>& weights, Seeds& seeds) const {
    const std::vector<std::vector<double>> angles = adjoint::stepper::angles_along(s.model, s.trajectory);
    std::vector<std::vector<Matrix34>> velocities;
    if (has_kinetic(s.model)) velocities = adjoint::stepper::end_velocities(s.model, s.trajectory);
    for (size_t k = 0; k < weights.size(); ++k) {
        if (weights[k] == 0) continue;
        const size_t t = k + static_cast<size_t>(first_instant());
        EnergySeeds at(s, t, weights[k], seeds);
        if (has_kinetic(s.model)) at.add_kinetic(velocities[t - 1]);
        if (has(EnergyKind::potential)) at.add_potential();
        if (has(EnergyKind::spring)) at.add_spring(angles[t]);
        at.finish();
    }
}

Errors Energy::check(const core::model::Model& model, int steps) const {
    Errors errors = StepSeries::check(model, steps);
    if (kind_ == EnergyKind::kinetic && model.integrator == core::scene::Integrator::quasi_static)
        errors.push_back({ErrorCode::inconsistent, "", "a quasi-static simulation has no velocities, so no kinetic energy"});
    for (const Body& body : model.bodies) {
        if (kind_ == EnergyKind::spring || !has_mass(body) || body.given_mass || adjoint::model::has_moments_of_mesh(body, model.dhat))
            continue;
        errors.push_back(
            {ErrorCode::unsupported, "",
             "the mass of body \"" + body.name + "\" is not that of its mesh and density: its energy cannot be differentiated"});
    }
    return errors;
}

}  // namespace fettle::design::quantities
