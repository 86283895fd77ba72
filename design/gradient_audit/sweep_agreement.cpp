// SPDX-License-Identifier: MIT
#include "design/gradient_audit/sweep_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/row_multipliers.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "design/gradient_audit/design_line.hpp"

namespace fettle::design::gradient_audit {
namespace {

using adjoint::ModelTangent;
using core::model::Model;
using core::stepper::Trajectory;

// 3 x 4: [[phi] R, dq].
Matrix34 motion_matrix(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 out;
    out << cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return out;
}

// A random direction by the sizes of things: each part of it counts about as much as the others.
ModelTangent random_direction(const Model& model, int steps, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double scale) { return Vector3(scale * Vector3::NullaryExpr([&] { return uniform(random); })); };
    ModelTangent d = adjoint::zero_model_tangent(model, steps);
    d.gravity_dot = vector(model.gravity.norm());
    const double duration = std::max(1, steps) * model.timestep;
    const int count = count_of(model.bodies);
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            if (may_collide(model, a, b) && friction_coefficient(model, a, b) > 0)
                d.friction_dot[{a, b}] = friction_coefficient(model, a, b) * uniform(random);
    for (size_t i = 0; i < model.bodies.size(); ++i) {
        const core::model::Body& body = model.bodies[i];
        adjoint::BodyTangent& dot = d.bodies[i];
        for (Eigen::Index j = 0; j < dot.vertices_dot.cols(); ++j) dot.vertices_dot.col(j) = vector(body.radius);
        dot.pose_start_dot << vector(body.radius), vector(1);
        Vector6 velocity;
        velocity << vector(body.radius / duration), vector(1 / duration);
        dot.velocity_start_dot = motion_matrix(velocity, body.pose_start.rotation);
        dot.density_dot = body.density * uniform(random);
        dot.force_dot = vector(body.moments(3, 3) * model.gravity.norm());
        for (Vector6& increment : dot.increment_dot)
            for (int k = 0; k < 6; ++k)
                if (!is_free(body, k)) increment[k] = (k < 3 ? body.radius : 1) * uniform(random) / std::max(1, steps);
    }
    return d;
}

// A sum, and that of its parts' magnitudes.
struct Pairing {
    double sum = 0, parts = 0;
    void add(double part) {
        sum += part;
        parts += std::abs(part);
    }
};

Pairing backwards(const Model& model, const adjoint::ModelGradient& gradient, const ModelTangent& direction) {
    Pairing out;
    out.add(gradient.gravity_bar.dot(direction.gravity_dot));
    for (const auto& [pair, dot] : direction.friction_dot)
        if (const auto bar = gradient.friction_bar.find(pair); bar != gradient.friction_bar.end()) out.add(bar->second * dot);
    for (size_t i = 0; i < model.bodies.size(); ++i) {
        const adjoint::BodyGradient& bar = gradient.bodies[i];
        const adjoint::BodyTangent& dot = direction.bodies[i];
        out.add(bar.vertices_bar.cwiseProduct(dot.vertices_dot).sum());
        out.add(bar.pose_start_bar.cwiseProduct(motion_matrix(dot.pose_start_dot, model.bodies[i].pose_start.rotation)).sum());
        out.add(bar.velocity_start_bar.cwiseProduct(dot.velocity_start_dot).sum());
        out.add(bar.density_bar * dot.density_dot);
        out.add(bar.force_bar.dot(dot.force_dot));
        for (size_t t = 0; t < bar.increment_bar.size(); ++t) out.add(bar.increment_bar[t].dot(dot.increment_dot[t]));
    }
    return out;
}

struct Motion {
    std::vector<std::vector<Vector6>> poses;
    adjoint::stepper::StepTangents within;
};

// The product of a seed and a change, over the steps that the seed has, some or none.
double within_steps(const std::vector<std::vector<Matrix34>>& bars, const std::vector<std::vector<Matrix34>>& dots) {
    double sum = 0;
    for (size_t t = 0; t < bars.size(); ++t)
        for (size_t i = 0; i < bars[t].size(); ++i) sum += bars[t][i].cwiseProduct(dots[t][i]).sum();
    return sum;
}

double forwards(const adjoint::TrajectoryGradient& seed, const Trajectory& trajectory, const Motion& motion) {
    double sum = 0;
    for (size_t t = 0; t < motion.poses.size(); ++t)
        for (size_t i = 0; i < motion.poses[t].size(); ++i)
            sum += seed.pose_bar[t][i].cwiseProduct(motion_matrix(motion.poses[t][i], trajectory.poses[t][i].rotation)).sum();
    for (size_t t = 0; t < seed.multiplier_bar.size(); ++t)
        if (seed.multiplier_bar[t].size() > 0) sum += seed.multiplier_bar[t].dot(motion.within.multipliers[t]);
    return sum + within_steps(seed.velocity_bar, motion.within.velocities) + within_steps(seed.lag_bar, motion.within.lags);
}

// The change of the quantity if every body moved as far as the direction moves the start, and as fast, and if the forces of constraints
// came and went.
// @param multipliers  [step], of the rows; none: the seed asks for none.
double reach_of(const adjoint::TrajectoryGradient& seed, const Trajectory& trajectory, const ModelTangent& direction,
                const std::vector<VectorX>& multipliers) {
    double sum = 0;
    const auto add = [&](const std::vector<std::vector<Matrix34>>& bars, const auto& dot_of) {
        for (size_t t = 0; t < bars.size(); ++t)
            for (size_t i = 0; i < bars[t].size(); ++i) sum += std::abs(bars[t][i].cwiseProduct(dot_of(t, i)).sum());
    };
    const auto moved = [&](size_t t, size_t i) {
        return motion_matrix(direction.bodies[i].pose_start_dot, trajectory.poses[t][i].rotation);
    };
    add(seed.pose_bar, moved);
    add(seed.lag_bar, moved);
    add(seed.velocity_bar, [&](size_t, size_t i) -> const Matrix34& { return direction.bodies[i].velocity_start_dot; });
    for (size_t t = 0; t < seed.multiplier_bar.size(); ++t)
        if (seed.multiplier_bar[t].size() > 0) sum += seed.multiplier_bar[t].cwiseProduct(multipliers[t]).lpNorm<1>();
    return sum;
}

// The seeds of the objective and of each constraint that depend on the motion of one scenario.
std::vector<adjoint::TrajectoryGradient> motion_seeds(const description::Design& design, const problem::DesignEvaluation& at,
                                                      const description::Simulated& simulated) {
    const auto zero = [&] { return adjoint::zero_seeds(simulated.model, count_of(simulated.trajectory.steps)); };
    std::vector<adjoint::TrajectoryGradient> out;
    const auto add = [&](const description::Quantity& quantity, const description::Measurement& measured, double scale,
                         adjoint::Seeds& seeds) {
        if (quantity.is_about(simulated.scenario)) quantity.add_seeds(simulated, measured, scale, seeds);
    };
    adjoint::Seeds objective = zero();
    for (size_t k = 0; k < design.objective.size(); ++k) {
        const description::ObjectiveTerm& term = design.objective[k];
        add(*term.quantity, at.terms[k], term.weight / term.unit, objective);
    }
    out.push_back(std::move(objective.trajectory_bar));
    for (size_t k = 0; k < design.constraints.size(); ++k) {
        adjoint::Seeds seeds = zero();
        add(*design.constraints[k].quantity, at.constraints[k], 1, seeds);
        out.push_back(std::move(seeds.trajectory_bar));
    }
    return out;
}

// Along two directions of a scenario's model; the worst is kept.
void compare(const description::Simulated& simulated, const std::vector<adjoint::TrajectoryGradient>& seeds,
             const std::vector<std::string>& names, SweepAgreement& out) {
    constexpr int directions = 2;
    const Model& model = simulated.model;
    const Trajectory& trajectory = simulated.trajectory;
    const auto gradients = adjoint::stepper::reverse_sweep(model, trajectory, seeds);
    if (!gradients) {
        out.failure = gradients.errors().front().message;
        return;
    }
    std::vector<VectorX> multipliers;
    if (std::any_of(seeds.begin(), seeds.end(), [](const auto& seed) { return !seed.multiplier_bar.empty(); }))
        multipliers = adjoint::stepper::row_multipliers(model, trajectory);
    std::mt19937_64 random(20261123);
    for (int d = 0; d < directions; ++d) {
        const ModelTangent direction = random_direction(model, count_of(trajectory.steps), random);
        Motion motion;
        auto poses = adjoint::stepper::tangent_sweep(model, trajectory, direction, &motion.within);
        if (!poses) {
            out.failure = poses.errors().front().message;
            return;
        }
        motion.poses = std::move(poses).value();
        for (size_t q = 0; q < seeds.size(); ++q) {
            const Pairing back = backwards(model, (*gradients)[q], direction);
            const double forth = forwards(seeds[q], trajectory, motion);
            // Where motors or springs drive a quantity, nothing in the direction moves it, and both are rounding.
            const double nothing = 1e-6 * reach_of(seeds[q], trajectory, direction, multipliers);
            const double scale = std::max({std::abs(back.sum), std::abs(forth), 1e-2 * back.parts, nothing});
            double apart = back.sum == forth ? 0 : std::abs(back.sum - forth) / scale;
            if (!std::isfinite(apart)) apart = core::base::infinity;
            if (apart <= out.disagreement) continue;
            out.disagreement = apart;
            out.quantity = names[q];
        }
    }
}

}  // namespace

SweepAgreement compare_sweeps(const problem::DesignProblem& problem, const problem::DesignEvaluation& at) {
    FETTLE_ASSERT(at.usable && at.gradient.size() == problem.parameter_count(), "the gradients to check");
    const problem::SimulatedDesign simulated(problem.design(), at);
    const std::vector<std::string> names = quantity_names(problem.design());
    SweepAgreement out;
    for (int s = 0; s < problem.scenario_count() && out.failure.empty(); ++s)
        compare(simulated.in(s), motion_seeds(problem.design(), at, simulated.in(s)), names, out);
    return out;
}

}  // namespace fettle::design::gradient_audit
