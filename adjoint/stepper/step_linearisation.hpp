// SPDX-License-Identifier: MIT
/// One step linearised about its solution: what the reverse and the forward sweep share. Everything is computed anew from the trajectory's
/// configurations (friction's lag, true Hessian, and the contacts where it has not kept them), so that a trajectory needs to store nothing
/// else, but for where the rounds of friction ended.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "adjoint/energy/term_adjoint.hpp"
#include "core/base/result.hpp"
#include "core/energy/incremental_potential.hpp"
#include "core/linear/linear_system.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::adjoint::stepper {

/// Or one of its rounds of friction: then "the step's end" is the round's.
struct LinearisedStep {
    core::energy::StepProblem problem;
    std::vector<core::kinematics::Pose> poses;           ///< at the step's end
    std::vector<core::kinematics::ChartPoint> points;    ///< the same in the step's chart
    core::contact::ContactSet contacts;                  ///< at the step's end
    std::shared_ptr<const contact::LaggedContacts> lag;  ///< what friction was taken from; null: there is none
    core::energy::ChartDerivatives derivatives;          ///< gradient and true Hessian in the chart (q, theta), of the Lagrangian
    core::linear::RowJacobian rows;                      ///< of joints and motors, in the chart
    VectorX multipliers;                                 ///< per row: those that balance the potential's gradient
    energy::StepEnd end() const { return {{problem, poses, contacts, core::contact::HessianKind::exact}, lag.get()}; }
};

/// What a sweep has done so far.
struct SweepCounts {
    int assemblies = 0;      ///< of a true Hessian
    int factorisations = 0;  ///< of a step's matrix; of a saddle system that of the masses, for the multipliers, too
    int solves = 0;          ///< of all right-hand sides at once; refinement counts with its solve
};

/// The system of one step: H over the free degrees of freedom, or [H C^T; C 0] where there are rows.
class StepSolver {
public:
    explicit StepSolver(const core::model::Model& model);

    const core::linear::FreeDofs& dofs() const { return system_.dofs(); }
    const SweepCounts& counts() const { return counts_; }
    void count_assembly() { ++counts_.assemblies; }

    /// Errors (inconsistent), with the step and the time: a body's forces do not balance to `balanced` of their sizes, or joints are not
    /// met, since the trajectory was not solved for gradients, or with another kappa; the matrix is singular. Unsupported: of an
    /// area-weighted barrier two edges in contact whose areas are the same.
    Errors factorise(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step);

    struct Solution {
        MatrixX y, mu;       ///< one column per right-hand side
        bool is_one = true;  ///< false: it does not solve the system, which is singular up to rounding; see unsolved()
    };
    /// With iterative refinement: the barrier makes H stiff. @param of_rows  as many columns as `rhs`; without rows irrelevant.
    Solution solve(const LinearisedStep& step, const MatrixX& rhs, const MatrixX& of_rows) const;

    /// The multipliers at the end of a step, whose derivatives are those of the potential alone: C^T m = -gradient over the free
    /// coordinates. NaNs where the masses' matrix has no factor.
    VectorX multipliers(const LinearisedStep& step);

    /// The error about the whole step, where there is no solution.
    static Errors unsolved(const core::stepper::Trajectory& trajectory, int t);

    /// The error about a quasi-static step, where friction's normal forces depend so much on themselves that the simulation's rounds have
    /// not settled, or `most_repeats` solves leave more than `repeated` of what they had at first.
    static Errors unsettled(const core::stepper::Trajectory& trajectory, int t);
    static constexpr int most_repeats = 200;
    static constexpr double repeated = 1e-13;

    /// Largest share of its forces by which a body may be out of balance; what would move it by this much of the scene's size is none.
    static constexpr double balanced = 1e-6, rounding_of_places = 1e-14;

private:
    Errors check_balance(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step) const;
    static Errors check_rows(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step);
    static Errors check_areas(const core::stepper::Trajectory& trajectory, int t, const LinearisedStep& step);

    mutable SweepCounts counts_;
    core::linear::LinearSystem system_;
};

/// Angles of the mechanism's measures with their turns at the start of each step, and at the end: [t], t = 0 .. steps.
std::vector<std::vector<double>> angles_along(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// Newmark's velocities and accelerations, which a trajectory does not store; of other integrators nothing.
struct NewmarkHistory {
    std::vector<std::vector<Matrix34>> velocities, accelerations;  ///< [t][body], t = 0 .. steps - 1
};

/// What of a step's start follows from all the steps before it, and which rows are solved for in it.
struct SweepHistory {
    std::vector<std::vector<double>> angles;  ///< angles_along
    NewmarkHistory newmark;
    /// [step]: the model with the rows that are independent at the step's end (core/model/row_choice.hpp); null: these are its own.
    std::vector<std::shared_ptr<const core::model::Model>> models;
};
SweepHistory sweep_history(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// Values of the rows that a step is solved with as those of all rows, by number, with 0 for the others; and back.
VectorX by_number(const LinearisedStep& step, const VectorX& values);
VectorX of_rows(const LinearisedStep& step, const VectorX& by_number);

/// What step t minimises, which leads from trajectory.poses[t] to poses[t + 1].
core::energy::StepProblem problem_at(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                                     const SweepHistory& history);

/// The rounds of friction of step t, which leads from trajectory.poses[t] to poses[t + 1]: each a solve of its own, with the normal forces
/// and tangents of where the one before ended, the first with those of the step's start. Without friction there is one.
class StepRounds {
public:
    /// @param known   contacts at the step's start or end, where they are known: those of the step before or after; else they are found.
    StepRounds(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t, const SweepHistory& history,
               std::shared_ptr<const contact::LaggedContacts> known = nullptr);

    int count() const { return count_of(ends_) - 1; }

    /// Quasi-static steps with friction: one round, whose lag is that of its own end (solver/newton.hpp).
    bool is_fixed_point() const { return is_fixed_point_; }

    /// What all of them minimise, without friction.
    const core::energy::StepProblem& problem() const { return problem_; }

    /// Contacts where friction was taken from for the first round (null without friction), and at the step's end.
    const std::shared_ptr<const contact::LaggedContacts>& at_start() const { return ends_.front().at; }
    const std::shared_ptr<const contact::LaggedContacts>& at_end() const { return ends_.back().at; }

    /// What the last round took friction from; null without friction.
    const std::shared_ptr<const contact::LaggedContacts>& last_lag() const { return ends_[ends_.size() - 2].at; }

    /// @param round  1 .. count(); the last is the step's end.
    LinearisedStep linearise(int round, StepSolver& solver) const;

private:
    struct End {
        std::vector<core::kinematics::ChartPoint> points;
        std::shared_ptr<const contact::LaggedContacts> at;
    };
    /// @param kept  the contacts there, as the trajectory has them; null: it has none
    void add_end(std::vector<core::kinematics::ChartPoint> points, std::vector<core::kinematics::Pose> poses,
                 const core::stepper::KeptContacts* kept);

    core::energy::StepProblem problem_;
    std::shared_ptr<const contact::LaggedContacts> known_;
    std::vector<End> ends_;  // the first is where friction was taken from for the first round; empty without friction
    bool is_fixed_point_ = false;
};

/// The last round of that step.
LinearisedStep linearise_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int t,
                              const SweepHistory& history, StepSolver& solver);

/// All three rotations free: the end pose then does not depend on where the step's chart is based.
bool rotates_freely(const core::model::Body& body);

}  // namespace fettle::adjoint::stepper
