// SPDX-License-Identifier: MIT
#include "adjoint/stepper/tangent_sweep.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

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

using core::kinematics::RotationDerivatives;
using core::model::Body;
using core::model::Model;
using core::stepper::Trajectory;

Matrix34 matrix_of(const Vector6& tangent, const Matrix3& rotation) {
    Matrix34 p;
    p << cross_matrix(tangent.tail<3>()) * rotation, tangent.head<3>();
    return p;
}

Vector6 tangent_of(const Matrix34& pose_dot, const Matrix3& rotation) {
    const Matrix3 s = pose_dot.leftCols<3>() * rotation.transpose();
    Vector6 out;
    out << pose_dot.col(3), 0.5 * Vector3(s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1));
    return out;
}

double inner(const Matrix3& a, const Matrix3& b) { return a.cwiseProduct(b).sum(); }

const Matrix3& second_derivative(const RotationDerivatives& r, int a, int b) {
    static constexpr std::array<std::array<int, 3>, 3> place{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    return r.hessian[place[a][b]];
}

class TangentSweep {
public:
    TangentSweep(const Model& model, const Trajectory& trajectory, const ModelTangent& direction)
        : model_(model),
          trajectory_(trajectory),
          direction_(direction),
          solver_(model),
          dofs_(solver_.dofs()),
          history_(sweep_history(model, trajectory)) {
        FETTLE_ASSERT(direction.bodies.size() == model.bodies.size(), "a direction has an entry for each body");
        for (std::size_t i = 0; i < model.bodies.size(); ++i) {
            const Body& body = model.bodies[i];
            const BodyTangent& dot = direction.bodies[i];
            moments_dot_.push_back(model::mass_moments_tangent(body, model.dhat, dot));
            poses_dot_.push_back(matrix_of(dot.pose_start_dot, trajectory.poses[0][i].rotation));
            velocities_dot_.push_back(dot.velocity_start_dot);
            if (model.area_weighted) areas_dot_.push_back(contact::areas_tangent(body.mesh, dot.vertices_dot));
        }
        if (is_newmark()) accelerations_dot_ = energy::start_accelerations_tangent(model, {direction, poses_dot_, moments_dot_});
        poses_before_dot_ = poses_dot_;  // irrelevant in the first step
        out_.push_back(tangents(0));
    }

    Errors run() {
        for (int t = 0; t < count_of(trajectory_.steps); ++t)
            if (Errors errors = step(t); !errors.empty()) return errors;
        return {};
    }

    std::vector<std::vector<Vector6>> take() { return std::move(out_); }
    StepTangents take_within() { return std::move(within_); }

private:
    std::vector<Vector6> tangents(int t) const {
        std::vector<Vector6> out(poses_dot_.size());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = tangent_of(poses_dot_[i], trajectory_.poses[t][i].rotation);
        return out;
    }

    // dP/dy_k of a body in the step's chart.
    Matrix34 chart_direction(int t, std::size_t i, const RotationDerivatives& r, int k) const {
        Matrix34 d = Matrix34::Zero();
        if (k < 3)
            d(k, 3) = 1;
        else
            d.leftCols<3>() = r.gradient[k - 3] * trajectory_.poses[t][i].rotation;
        return d;
    }

    // The end pose's change with the unknowns held: the chart's base, the prescribed positions and increments.
    Matrix34 known_change(int t, std::size_t i, const RotationDerivatives& r) const {
        const Body& body = model_.bodies[i];
        Matrix34 change = Matrix34::Zero();
        change.leftCols<3>() = r.value * poses_dot_[i].leftCols<3>();
        for (int k = 0; k < 6; ++k) {
            if (is_free(body, k)) continue;
            change += direction_.bodies[i].increment_dot[t][k] * chart_direction(t, i, r, k);
            if (k < 3) change(k, 3) += poses_dot_[i](k, 3);
        }
        return change;
    }

    // Change of dE/dy_k with the unknowns held, for dE/dP = value and its change.
    double residual_change(int t, std::size_t i, const RotationDerivatives& r, int k, const Matrix34& value, const Matrix34& dot) const {
        if (k < 3) return dot(k, 3);
        const int a = k - 3;
        const Matrix3& base = trajectory_.poses[t][i].rotation;
        double change =
            inner(dot.leftCols<3>(), r.gradient[a] * base) + inner(value.leftCols<3>(), r.gradient[a] * poses_dot_[i].leftCols<3>());
        for (int b = 0; b < 3; ++b)
            if (!is_free(model_.bodies[i], b + 3))
                change += direction_.bodies[i].increment_dot[t][b + 3] * inner(value.leftCols<3>(), second_derivative(r, a, b) * base);
        return change;
    }

    bool is_newmark() const { return model_.integrator == core::scene::Integrator::newmark; }

    // The change of the constant that acts on theta as the body's torque.
    Vector3 torque_change(int t, std::size_t i, const LinearisedStep& step, const Matrix34& pose_hat_dot) const {
        const BodyTangent& dot = direction_.bodies[i];
        if (!energy::has_chart_torque(model_)) return dot.torque_dot;
        return energy::chart_torque_tangent(model_.bodies[i].torque, trajectory_.poses[t][i].rotation, step.problem.pose_hat[i],
                                            {dot.torque_dot, poses_dot_[i].leftCols<3>(), pose_hat_dot.leftCols<3>()});
    }

    bool is_bdf2(int t) const { return model_.integrator == core::scene::Integrator::bdf2 && t > 0; }

    Matrix34 slip_change(int t, std::size_t i) const {
        if (is_newmark()) return poses_dot_[i] + 0.5 * model_.timestep * velocities_dot_[i];
        return is_bdf2(t) ? Matrix34((4 * poses_dot_[i] - poses_before_dot_[i]) / 3) : poses_dot_[i];
    }

    Matrix34 pose_hat_change(int t, std::size_t i) const {
        if (model_.integrator == core::scene::Integrator::quasi_static) return poses_dot_[i];
        const double h = model_.timestep;
        if (is_bdf2(t)) {
            Matrix34 change = slip_change(t, i) + 2 * h / 9 * (4 * velocities_dot_[i] - velocities_before_dot_[i]);
            change.col(3) += 4 * h * h / 9 * direction_.gravity_dot;
            return change;
        }
        if (is_newmark()) {
            Matrix34 change = poses_dot_[i] + h * velocities_dot_[i] + 0.25 * h * h * accelerations_dot_[i];
            change.col(3) += 0.25 * h * h * direction_.gravity_dot;
            return change;
        }
        Matrix34 change = poses_dot_[i] + h * velocities_dot_[i];
        change.col(3) += h * h * direction_.gravity_dot;
        return change;
    }

    // The constants of a step, and how they change; of the end what changes with the unknowns held.
    struct StepChange {
        std::vector<RotationDerivatives> r;  // of the round at hand
        std::vector<Matrix34> pose_hat_dot, slip_dot;
    };

    Errors step(int t) {
        const StepRounds rounds(model_, trajectory_, t, history_, std::move(known_));
        known_ = rounds.at_end();
        StepChange change;
        for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
            change.pose_hat_dot.push_back(pose_hat_change(t, i));
            change.slip_dot.push_back(slip_change(t, i));
        }
        std::vector<Matrix34> end_dot = poses_dot_;
        for (int round = 1; round <= rounds.count(); ++round) {
            const LinearisedStep step = rounds.linearise(round, solver_);
            if (Errors errors = solver_.factorise(trajectory_, t, step); !errors.empty()) return errors;
            if (rounds.is_fixed_point()) {
                if (Errors errors = fixed_point(t, step, change, end_dot); !errors.empty()) return errors;
            } else if (!solve(t, step, change, end_dot)) {
                return StepSolver::unsolved(trajectory_, t);
            }
        }
        within_.multipliers.push_back(multiplier_dot_);
        within_.lags.push_back(lag_dot_);
        advance(t, end_dot);
        within_.velocities.push_back(velocities_dot_);
        return {};
    }

    // One solve: end_dot belongs to where friction was taken from, and becomes that of the round's end.
    // @return whether there is a solution.
    bool solve(int t, const LinearisedStep& step, StepChange& change, std::vector<Matrix34>& end_dot) {
        const std::size_t n = model_.bodies.size();
        lag_dot_ = end_dot;
        change.r.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            change.r[i] = core::kinematics::rotation_derivatives(step.points[i].rotation_vector);
            end_dot[i] = known_change(t, i, change.r[i]);
        }
        contact::PoseGradientTangent energy = adjoint::energy::terms_tangent(
            step.end(), {end_dot, change.pose_hat_dot, change.slip_dot, poses_dot_, poses_before_dot_, moments_dot_, areas_dot_, lag_dot_},
            direction_);
        VectorX row_dot;
        if (step.rows.count() > 0)
            row_dot = constraint::add_rows_tangent({step.problem, step.poses, step.multipliers}, end_dot, direction_, energy);
        std::vector<Vector6> residual_dot(n), y_dot(n, Vector6::Zero());
        for (std::size_t i = 0; i < n; ++i)
            for (int k = 0; k < 6; ++k) residual_dot[i][k] = residual_change(t, i, change.r[i], k, energy.value[i], energy.dot[i]);
        for (std::size_t i = 0; i < n; ++i)
            residual_dot[i].tail<3>() -= step.problem.weight * torque_change(t, i, step, change.pose_hat_dot[i]);
        const MatrixX rhs = -gather(dofs_, residual_dot);
        const StepSolver::Solution solution = solver_.solve(step, rhs, -row_dot);
        scatter(dofs_, solution.y.col(0), y_dot);
        multiplier_dot_ = step.rows.count() > 0 ? by_number(step, solution.mu.col(0)) : VectorX();
        for (std::size_t i = 0; i < n; ++i)
            for (int k = 0; k < 6; ++k) end_dot[i] += y_dot[i][k] * chart_direction(t, i, change.r[i], k);
        return solution.is_one;
    }

    // Friction was taken from the end itself: again until the end changes as it is assumed to.
    Errors fixed_point(int t, const LinearisedStep& step, StepChange& change, std::vector<Matrix34>& end_dot) {
        for (int k = 0; k < StepSolver::most_repeats; ++k) {
            const std::vector<Matrix34> assumed = end_dot;
            if (!solve(t, step, change, end_dot)) return StepSolver::unsolved(trajectory_, t);
            double left = 0, all = 0;
            for (std::size_t i = 0; i < end_dot.size(); ++i) {
                left = std::max(left, (end_dot[i] - assumed[i]).cwiseAbs().maxCoeff());
                all = std::max(all, end_dot[i].cwiseAbs().maxCoeff());
            }
            if (left <= StepSolver::repeated * all) return {};
        }
        return StepSolver::unsettled(trajectory_, t);
    }

    // Newmark's V and A at the step's end.
    void advance_rates(int t, std::size_t i, const Matrix34& end_dot) {
        if (!core::energy::has_free_dof(model_.bodies[i])) {
            velocities_dot_[i] = (end_dot - poses_dot_[i]) / model_.timestep;
            return;
        }
        const NewmarkHistory& newmark = history_.newmark;
        const energy::NewmarkRates rates =
            energy::newmark_rates_tangent({model_.bodies[i], model_.timestep, pose_matrix(trajectory_.poses[t][i]),
                                           newmark.velocities[t][i], newmark.accelerations[t][i], trajectory_.poses[t + 1][i]},
                                          {poses_dot_[i], velocities_dot_[i], accelerations_dot_[i], end_dot, moments_dot_[i]});
        velocities_dot_[i] = rates.velocity;
        accelerations_dot_[i] = rates.acceleration;
    }

    void advance(int t, const std::vector<Matrix34>& end_dot) {
        const std::vector<Matrix34> velocities = velocities_dot_, poses = poses_dot_;
        for (std::size_t i = 0; i < end_dot.size(); ++i) {
            const Matrix3& rotation = trajectory_.poses[t + 1][i].rotation;
            const Matrix34 next = matrix_of(tangent_of(end_dot[i], rotation), rotation);  // rounding must not leave the tangent space
            if (is_newmark())
                advance_rates(t, i, next);
            else if (is_bdf2(t) && core::energy::has_free_dof(model_.bodies[i]))
                velocities_dot_[i] = (next - slip_change(t, i)) / (2 * model_.timestep / 3);
            else
                velocities_dot_[i] = (next - poses_dot_[i]) / model_.timestep;
            poses_dot_[i] = next;
        }
        velocities_before_dot_ = velocities;
        poses_before_dot_ = poses;
        out_.push_back(tangents(t + 1));
    }

    const Model& model_;
    const Trajectory& trajectory_;
    const ModelTangent& direction_;
    StepSolver solver_;
    const core::linear::FreeDofs dofs_;
    const SweepHistory history_;
    std::vector<Matrix4> moments_dot_;
    std::vector<contact::AreaChange> areas_dot_;
    std::vector<Matrix34> poses_dot_, velocities_dot_;                // at the current step's start
    std::vector<Matrix34> poses_before_dot_, velocities_before_dot_;  // at the start of the one before
    std::vector<Matrix34> accelerations_dot_;                         // Newmark
    std::vector<std::vector<Vector6>> out_;
    StepTangents within_;
    VectorX multiplier_dot_;                                // of the round at hand
    std::vector<Matrix34> lag_dot_;                         // the same
    std::shared_ptr<const contact::LaggedContacts> known_;  // at the end of the step before
};

}  // namespace

Result<std::vector<std::vector<Vector6>>> tangent_sweep(const Model& model, const Trajectory& trajectory, const ModelTangent& direction,
                                                        StepTangents* within) {
    if (Errors errors = check_differentiable(model, trajectory); !errors.empty()) return errors;
    TangentSweep sweep(model, trajectory, direction);
    if (Errors errors = sweep.run(); !errors.empty()) return errors;
    if (within != nullptr) *within = sweep.take_within();
    return sweep.take();
}

}  // namespace fettle::adjoint::stepper
