// SPDX-License-Identifier: MIT
#include "adjoint/stepper/reverse_sweep.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "adjoint/constraint/row_adjoint.hpp"
#include "adjoint/energy/incremental_potential_adjoint.hpp"
#include "adjoint/energy/start_history_adjoint.hpp"
#include "adjoint/energy/time_integration_adjoint.hpp"
#include "adjoint/model/body_mass_adjoint.hpp"
#include "adjoint/stepper/check_differentiable.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "core/base/contract.hpp"

namespace fettle::adjoint::stepper {
namespace {

using core::model::Body;
using core::model::Model;
using core::stepper::Trajectory;

// The left-rotation gradient of a gradient in the entries of R: <r_bar, [phi] R> = axial . phi.
Vector3 rotation_gradient(const Matrix3& r_bar, const Matrix3& rotation) {
    const Matrix3 s = r_bar * rotation.transpose();
    return {s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1)};
}

class ReverseSweep {
public:
    ReverseSweep(const Model& model, const Trajectory& trajectory, const std::vector<TrajectoryGradient>& seeds)
        : model_(model),
          trajectory_(trajectory),
          seeds_(seeds),
          solver_(model),
          dofs_(solver_.dofs()),
          history_(sweep_history(model, trajectory)) {
        const std::size_t bodies = model.bodies.size();
        const int steps = count_of(trajectory.steps);
        for (const TrajectoryGradient& seed : seeds)
            FETTLE_ASSERT(seed.pose_bar.size() == trajectory.poses.size(), "a seed has one pose gradient per stored configuration");
        out_.assign(seeds.size(), zero_model_gradient(model, steps));
        end_.assign(seeds.size(), std::vector<Matrix34>(bodies, Matrix34::Zero()));
        start_ = before_ = end_;
        velocity_end_ = velocity_start_ = velocity_before_ = acceleration_end_ = acceleration_start_ = end_;
        step_bar_.pose_hat_bar = step_bar_.slip_reference_bar = step_bar_.start_bar = step_bar_.before_bar = step_bar_.lag_poses_bar = end_;
        step_bar_.moments_bar.assign(seeds.size(), std::vector<Matrix4>(bodies, Matrix4::Zero()));
        step_bar_.areas_bar.resize(seeds.size());
        for (auto& of_seed : step_bar_.areas_bar)
            for (std::size_t i = 0; model.area_weighted && i < bodies; ++i) of_seed.push_back(contact::zero_areas(model.bodies[i]));
        y_bar_.assign(seeds.size(), std::vector<Vector6>(bodies, Vector6::Zero()));
        lambda_ = motion_ = y_bar_;
        mu_.resize(seeds.size());
        left_jacobian_.resize(bodies);
    }

    Errors run() {
        const int steps = count_of(trajectory_.steps);
        add_seeds(steps, end_);
        if (steps > 0) add_seeds(steps - 1, start_);
        for (int t = steps - 1; t >= 0; --t) {
            if (t > 0) add_seeds(t - 1, before_);
            if (is_newmark()) add_seeds_of(t, &TrajectoryGradient::velocity_bar, velocity_end_);
            if (Errors errors = step_back(t); !errors.empty()) return errors;
            for (auto& bodies : end_)
                for (Matrix34& p : bodies) p.setZero();
            // end <- start <- before <- zero
            std::swap(end_, start_);
            std::swap(start_, before_);
            if (is_bdf2() || is_newmark()) rotate_velocities();
        }
        finish();
        return {};
    }

    const SweepCounts& counts() const { return solver_.counts(); }
    std::vector<ModelGradient> take() { return std::move(out_); }

private:
    void add_seeds(int t, std::vector<std::vector<Matrix34>>& pose_bar) const {
        for (std::size_t s = 0; s < seeds_.size(); ++s)
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) pose_bar[s][i] += seeds_[s].pose_bar[t][i];
    }

    // Adds the seeds of the step, where there are any.
    void add_seeds_of(int t, std::vector<std::vector<Matrix34>> TrajectoryGradient::*which, std::vector<std::vector<Matrix34>>& to) const {
        for (std::size_t s = 0; s < seeds_.size(); ++s) {
            const std::vector<std::vector<Matrix34>>& bar = seeds_[s].*which;
            if (bar.empty() || bar[t].empty()) continue;
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) to[s][i] += bar[t][i];
        }
    }

    bool is_bdf2() const { return model_.integrator == core::scene::Integrator::bdf2; }
    bool is_newmark() const { return model_.integrator == core::scene::Integrator::newmark; }

    void rotate_velocities() {
        for (auto& bodies : velocity_end_)
            for (Matrix34& p : bodies) p.setZero();
        std::swap(velocity_end_, velocity_start_);
        std::swap(velocity_start_, velocity_before_);
        for (auto& bodies : acceleration_end_)
            for (Matrix34& p : bodies) p.setZero();
        std::swap(acceleration_end_, acceleration_start_);
    }

    energy::NewmarkStep newmark_step(int t, std::size_t i) const {
        const NewmarkHistory& newmark = history_.newmark;
        return {model_.bodies[i],
                model_.timestep,
                pose_matrix(trajectory_.poses[t][i]),
                newmark.velocities[t][i],
                newmark.accelerations[t][i],
                trajectory_.poses[t + 1][i]};
    }

    // Newmark's V and A at the step's end.
    void rates_back(int t) {
        for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
            const bool is_solved_for = core::energy::has_free_dof(model_.bodies[i]);
            for (std::size_t s = 0; s < seeds_.size(); ++s) {
                if (!is_solved_for) {
                    const Matrix34 bar = velocity_end_[s][i] / model_.timestep;
                    end_[s][i] += bar;
                    start_[s][i] -= bar;
                    continue;
                }
                const energy::NewmarkStepChange bar =
                    energy::newmark_rates_adjoint(newmark_step(t, i), {velocity_end_[s][i], acceleration_end_[s][i]});
                end_[s][i] += bar.end;
                start_[s][i] += bar.before;
                velocity_start_[s][i] += bar.velocity;
                acceleration_start_[s][i] += bar.acceleration;
                step_bar_.moments_bar[s][i] += bar.moments;
            }
        }
    }

    // BDF2's V = (P - P_slip)/slip_time at the step's end.
    void velocity_back(const LinearisedStep& step) {
        for (std::size_t s = 0; s < seeds_.size(); ++s)
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
                const Matrix34 bar = velocity_end_[s][i] / step.problem.slip_time;
                end_[s][i] += bar;
                step_bar_.slip_reference_bar[s][i] -= bar;
            }
    }

    static void set_zero(std::vector<std::vector<Matrix34>>& bars) {
        for (auto& bodies : bars)
            for (Matrix34& bar : bodies) bar.setZero();
    }

    static double largest(const std::vector<std::vector<Matrix34>>& bars) {
        double out = 0;
        for (const auto& bodies : bars)
            for (const Matrix34& bar : bodies) out = std::max(out, bar.cwiseAbs().maxCoeff());
        return out;
    }

    // Through the rounds of friction, last to first: each hands back what it owes to where the one before ended.
    Errors step_back(int t) {
        const StepRounds rounds(model_, trajectory_, t, history_, std::move(known_));
        known_ = rounds.at_start();
        for (auto* bars : {&step_bar_.pose_hat_bar, &step_bar_.slip_reference_bar, &step_bar_.start_bar, &step_bar_.before_bar})
            set_zero(*bars);
        for (int round = rounds.count(); round > 0; --round) {
            const bool is_last = round == rounds.count();
            const LinearisedStep step = rounds.linearise(round, solver_);
            if (Errors errors = solver_.factorise(trajectory_, t, step); !errors.empty()) return errors;
            if (is_last && is_bdf2()) velocity_back(step);
            if (is_last && is_newmark()) rates_back(t);
            if (!round_back(t, step, is_last)) return StepSolver::unsolved(trajectory_, t);
            if (is_last && step.lag) add_seeds_of(t, &TrajectoryGradient::lag_bar, step_bar_.lag_poses_bar);
            if (rounds.is_fixed_point()) {
                if (Errors errors = fixed_point_back(t, step); !errors.empty()) return errors;
            } else if (round > 1) {
                std::swap(end_, step_bar_.lag_poses_bar);
                if (largest(end_) == 0) break;
            } else {
                add_lag_to_start();
            }
        }
        start_back(t, rounds.problem());
        return {};
    }

    // What the step's constants follow from.
    void start_back(int t, const core::energy::StepProblem& problem) {
        for (std::size_t s = 0; s < seeds_.size(); ++s)
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
                start_[s][i] += step_bar_.start_bar[s][i];
                if (is_bdf2())
                    bdf2_back(t, s, i, problem.slip_time);
                else if (is_newmark())
                    newmark_back(s, i, problem.weight);
                else
                    pose_hat_back(t, s, i);
            }
    }

    // One solve, from end_ to lag_poses_bar and the step's constants.
    // @return whether there is a solution.
    bool round_back(int t, const LinearisedStep& step, bool is_last) {
        set_zero(step_bar_.lag_poses_bar);
        if (!solve(t, step, is_last)) return false;
        energy::subtract_terms_reverse(step.end(), motion_, step_bar_, out_);
        if (step.rows.count() > 0) constraint::subtract_rows_reverse({step.problem, step.poses, step.multipliers}, motion_, mu_, out_);
        for (std::size_t s = 0; s < seeds_.size(); ++s) {
            std::vector<Vector6> h_lambda = core::linear::multiply(step.derivatives.hessian, lambda_[s]);
            if (step.rows.count() > 0) add_transposed(step.rows, mu_[s], h_lambda);
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
                torque_back(t, s, i, step);
                prescribed_back(t, s, i, step, h_lambda[i]);
            }
        }
        return true;
    }

    // The lag is that of the end itself: with B its part of the residual's derivative, lambda = H^-1 (y_bar - B^T lambda), a sum that falls
    // as the rounds of friction do.
    Errors fixed_point_back(int t, const LinearisedStep& step) {
        const double first = largest(step_bar_.lag_poses_bar);
        for (int k = 0; k < StepSolver::most_repeats; ++k) {
            const double left = largest(step_bar_.lag_poses_bar);
            if (left == 0 || left <= StepSolver::repeated * first) return {};
            std::swap(end_, step_bar_.lag_poses_bar);
            if (!round_back(t, step, false)) return StepSolver::unsolved(trajectory_, t);
        }
        return StepSolver::unsettled(trajectory_, t);
    }

    void add_lag_to_start() {
        for (std::size_t s = 0; s < seeds_.size(); ++s)
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) start_[s][i] += step_bar_.lag_poses_bar[s][i];
    }

    // y_bar, lambda, and lambda's motion (dq, phi) of each body.
    // @return whether there is a solution.
    bool solve(int t, const LinearisedStep& step, bool is_last) {
        for (std::size_t i = 0; i < model_.bodies.size(); ++i)
            left_jacobian_[i] = core::kinematics::left_jacobian(step.points[i].rotation_vector);
        MatrixX rhs(dofs_.count, seeds_.size());
        MatrixX of_rows = MatrixX::Zero(step.rows.count(), rhs.cols());
        for (std::size_t s = 0; s < seeds_.size(); ++s) {
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
                y_bar_[s][i].head<3>() = end_[s][i].col(3);
                y_bar_[s][i].tail<3>() =
                    left_jacobian_[i].transpose() * rotation_gradient(end_[s][i].leftCols<3>(), step.poses[i].rotation);
            }
            rhs.col(s) = gather(dofs_, y_bar_[s]);
            if (const auto& bar = seeds_[s].multiplier_bar; is_last && !bar.empty() && bar[t].size() > 0)
                of_rows.col(s) = stepper::of_rows(step, bar[t]);
        }
        const StepSolver::Solution solution = solver_.solve(step, rhs, of_rows);
        const MatrixX &lambda = solution.y, &mu = solution.mu;
        for (std::size_t s = 0; s < seeds_.size(); ++s) {
            if (step.rows.count() > 0) mu_[s] = mu.col(s);
            scatter(dofs_, lambda.col(s), lambda_[s]);
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
                motion_[s][i].head<3>() = lambda_[s][i].head<3>();
                motion_[s][i].tail<3>() = left_jacobian_[i] * lambda_[s][i].tail<3>();
            }
        }
        return solution.is_one;
    }

    // The chart's torque: its part of the residual is - weight torque . theta, constant in the chart.
    void torque_back(int t, std::size_t s, std::size_t i, const LinearisedStep& step) {
        const Body& body = model_.bodies[i];
        const Vector3 bar = step.problem.weight * lambda_[s][i].tail<3>();
        Vector3& torque_bar = out_[s].bodies[i].torque_bar;
        if (!energy::has_chart_torque(model_)) {
            torque_bar += bar;
            return;
        }
        const energy::ChartTorqueChange change =
            energy::chart_torque_adjoint(body.torque, trajectory_.poses[t][i].rotation, step.problem.pose_hat[i], bar);
        torque_bar += change.torque;
        step_bar_.pose_hat_bar[s][i].leftCols<3>() += change.hat;
        start_[s][i].leftCols<3>() += change.rotation;
    }

    // Prescribed coordinates' increments, and what they are measured from: the start's position and the chart's base.
    void prescribed_back(int t, std::size_t s, std::size_t i, const LinearisedStep& step, const Vector6& h_lambda) {
        const Body& body = model_.bodies[i];
        Vector6 increment_bar = Vector6::Zero();
        for (int k = 0; k < 6; ++k)
            if (!is_free(body, k)) increment_bar[k] = y_bar_[s][i][k] - h_lambda[k];
        out_[s].bodies[i].increment_bar[t] += increment_bar;
        start_[s][i].col(3) += increment_bar.head<3>();
        const bool has_torque = !body.torque.isZero(0);
        if (rotates_freely(body) && !has_torque) return;
        const Vector3& theta = step.points[i].rotation_vector;
        const Vector3 lambda_theta = lambda_[s][i].tail<3>(), phi = motion_[s][i].tail<3>();
        const Matrix3 back = core::kinematics::left_jacobian_inverse(theta).transpose();
        Vector3 chart_torque = step.derivatives.gradient[i].tail<3>();  // of what depends on poses alone
        if (has_torque) chart_torque += step.problem.weight * step.problem.torque[i];
        const Vector3 torque = back * chart_torque;
        const Matrix3 curvature = core::kinematics::chart_curvature(0.5 * cross_matrix(torque), theta);
        const Vector3 end_bar = back * (increment_bar.tail<3>() + curvature * lambda_theta) + 0.5 * phi.cross(torque);
        const Vector3 base_bar = core::kinematics::rotation(theta).transpose() * end_bar;
        start_[s][i].leftCols<3>() += 0.5 * cross_matrix(base_bar) * trajectory_.poses[t][i].rotation;
    }

    // P_hat of implicit Euler, from the two configurations before; a quasi-static one is the start. P_slip is the start for both.
    void pose_hat_back(int t, std::size_t s, std::size_t i) {
        const double h = model_.timestep;
        const Matrix34& pose_hat_bar = step_bar_.pose_hat_bar[s][i];
        start_[s][i] += step_bar_.slip_reference_bar[s][i];
        if (model_.integrator == core::scene::Integrator::quasi_static) {
            start_[s][i] += pose_hat_bar;
            return;
        }
        out_[s].gravity_bar += h * h * pose_hat_bar.col(3);
        if (t > 0) {
            start_[s][i] += 2 * pose_hat_bar;
            before_[s][i] -= pose_hat_bar;
        } else {
            start_[s][i] += pose_hat_bar;
            out_[s].bodies[i].velocity_start_bar += h * pose_hat_bar;
        }
    }

    // P_slip = (4 P_t - P_t-1)/3, P_hat = P_slip + slip_time (4 V_t - V_t-1)/3 + slip_time^2 gravity; at t = 0 implicit Euler's.
    void bdf2_back(int t, std::size_t s, std::size_t i, double slip_time) {
        const Matrix34& hat = step_bar_.pose_hat_bar[s][i];
        const Matrix34 slip = step_bar_.slip_reference_bar[s][i] + hat;
        out_[s].gravity_bar += slip_time * slip_time * hat.col(3);
        if (t == 0) {
            start_[s][i] += slip;
            out_[s].bodies[i].velocity_start_bar += velocity_start_[s][i] + slip_time * hat;
            return;
        }
        start_[s][i] += 4.0 / 3 * slip;
        before_[s][i] += step_bar_.before_bar[s][i] - 1.0 / 3 * slip;
        velocity_start_[s][i] += 4.0 / 3 * slip_time * hat;
        velocity_before_[s][i] -= 1.0 / 3 * slip_time * hat;
    }

    // P_slip = P + h/2 V, P_hat = P + h V + weight (A + [0 | gravity]), weight = h^2/4.
    void newmark_back(std::size_t s, std::size_t i, double weight) {
        const Matrix34 &hat = step_bar_.pose_hat_bar[s][i], &slip = step_bar_.slip_reference_bar[s][i];
        start_[s][i] += hat + slip;
        velocity_start_[s][i] += model_.timestep * (hat + 0.5 * slip);
        acceleration_start_[s][i] += weight * hat;
        out_[s].gravity_bar += weight * hat.col(3);
    }

    // V and A at the start.
    void newmark_start_back() {
        for (std::size_t s = 0; s < seeds_.size(); ++s)
            for (std::size_t i = 0; i < model_.bodies.size(); ++i) out_[s].bodies[i].velocity_start_bar += velocity_end_[s][i];
        energy::start_accelerations_adjoint(model_, acceleration_end_, {end_, step_bar_.moments_bar, out_});
    }

    // After the first step the swaps have left P_bar[0] in end_.
    void finish() {
        if (is_newmark()) newmark_start_back();
        for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
            const Body& body = model_.bodies[i];
            for (std::size_t s = 0; s < seeds_.size(); ++s) {
                BodyGradient& bar = out_[s].bodies[i];
                bar.pose_start_bar = end_[s][i];
                model::mass_moments_adjoint(body, model_.dhat, step_bar_.moments_bar[s][i], bar);
                if (model_.area_weighted) contact::areas_adjoint(body.mesh, step_bar_.areas_bar[s][i], bar.vertices_bar);
            }
        }
    }

    const Model& model_;
    const Trajectory& trajectory_;
    const std::vector<TrajectoryGradient>& seeds_;
    StepSolver solver_;
    const core::linear::FreeDofs dofs_;
    const SweepHistory history_;
    std::vector<ModelGradient> out_;
    std::vector<std::vector<Matrix34>> end_, start_, before_;                             // [seed][body]: P_bar[t+1], P_bar[t], P_bar[t-1]
    std::vector<std::vector<Matrix34>> velocity_end_, velocity_start_, velocity_before_;  // the same of V (BDF2, Newmark)
    std::vector<std::vector<Matrix34>> acceleration_end_, acceleration_start_;            // of A (Newmark)
    energy::StepGradient step_bar_;  // of the step at hand, the lag's of the round; moments' and areas' of all
    std::vector<std::vector<Vector6>> y_bar_, lambda_, motion_;
    std::shared_ptr<const contact::LaggedContacts> known_;  // with friction: at the start of the step that was gone through last
    std::vector<VectorX> mu_;                               // [seed]: adjoint variable of the rows
    std::vector<Matrix3> left_jacobian_;
};

}  // namespace

Result<std::vector<ModelGradient>> reverse_sweep(const Model& model, const Trajectory& trajectory,
                                                 const std::vector<TrajectoryGradient>& seeds, SweepCounts* counts) {
    if (Errors errors = check_differentiable(model, trajectory); !errors.empty()) return errors;
    ReverseSweep sweep(model, trajectory, seeds);
    if (Errors errors = sweep.run(); !errors.empty()) return errors;
    if (counts != nullptr) *counts = sweep.counts();
    return sweep.take();
}

}  // namespace fettle::adjoint::stepper
