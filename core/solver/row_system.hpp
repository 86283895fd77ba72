// SPDX-License-Identifier: MIT
/// Rows (joints, motors) in Newton's method (newton.hpp): their linearisation where an iteration stands, the step under them, and the way
/// back onto the rows from where a step has led. docs/method/joints.md#the-step-under-rows.
#pragma once

#include <vector>

#include "core/constraint/row.hpp"
#include "core/energy/incremental_potential.hpp"
#include "core/linear/linear_system.hpp"

namespace fettle::core::solver {

/// What is met to this share of the scene's size is met.
inline constexpr double met_gap = 1e-12;

class RowSystem {
public:
    /// Values and gradients in the chart at these points; adds the rows' curvature, by the multipliers that are known, to an exact Hessian.
    void linearise(const energy::StepProblem& problem, const std::vector<kinematics::ChartPoint>& points,
                   const std::vector<kinematics::Pose>& poses, contact::HessianKind kind, kinematics::BlockHessian& hessian);

    /// From now on, or no more: solves by as many passes of refinement as gain anything (linear_system.hpp).
    void refine_fully(bool fully) { passes_ = fully ? linear::LinearSystem::all_passes : linear::LinearSystem::usual_passes; }

    /// C, of what was linearised last.
    const linear::RowJacobian& jacobian() const { return jacobian_; }

    /// target - value per row; 0 of what is met.
    const VectorX& unmet() const { return unmet_; }
    /// Sum of |unmet|, in lengths [m].
    double unmet_norm() const { return unmet_norm_; }

    /// The step of the free coordinates: H y + C^T m = r,  C y = drive unmet + (what else remains) - C y_prescribed. Takes the multipliers
    /// along. @param system  of this Hessian and jacobian()  @param step  of the prescribed coordinates; the free ones are filled in.
    void solve_for_step(const linear::LinearSystem& system, const kinematics::BlockHessian& hessian, const VectorX& r, double drive,
                        std::vector<Vector6>& step);

    /// The multipliers of the last solve; carried from step to step, where they make the first Hessian's curvature.
    const VectorX& multipliers() const { return multipliers_; }
    void forget_multipliers() { multipliers_.resize(0); }

    /// Adds C^T multipliers to the gradients of the potential: the Lagrangian's. @return per body: sum of the rows' forces' magnitudes, in
    /// gradient units per metre.
    std::vector<double> add_forces(const model::Model& model, std::vector<Vector6>& gradient) const;

    /// multipliers . (drive unmet): what a step that takes this share of the rows costs the potential, beside the Lagrangian's slope.
    double work_of_unmet(double drive) const { return drive * multipliers_.dot(unmet_); }
    /// What the potential may be wrong by, as rows are met to rounding only.
    double work_of_rounding() const { return multipliers_.cwiseAbs().dot((remaining_ - unmet_).cwiseAbs()); }

    /// Moves the free coordinates of `points` to where each row has `share` left of what was unmet where it was linearised last, by solves
    /// with the system's last factor. @return false: too far for that.
    bool put_on_rows(const energy::StepProblem& problem, const linear::LinearSystem& system, double share,
                     std::vector<kinematics::ChartPoint>& points) const;

private:
    linear::RowJacobian jacobian_;
    VectorX remaining_, unmet_, multipliers_;
    double unmet_norm_ = 0;
    int passes_ = linear::LinearSystem::usual_passes;
};

/// Largest |value - target| of the rows, in lengths [m].
double largest_gap(const energy::StepProblem& problem, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::solver
