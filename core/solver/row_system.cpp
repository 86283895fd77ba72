// SPDX-License-Identifier: MIT
#include "core/solver/row_system.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::solver {
namespace {

using kinematics::ChartPoint;
using kinematics::Pose;

constexpr int most_corrections = 30;
constexpr double rounding_gap = 2e-15;  // of the scene's size: nothing is gained below
constexpr double slow_gain = 0.7;       // a correction that leaves more of the gap does not lead there

VectorX remaining_at(const energy::StepProblem& problem, const std::vector<measure::PlacedFrame>& frames) {
    const model::Mechanism& mechanism = problem.model->mechanism;
    return problem.mechanism.row_targets - row_values(mechanism.set, mechanism.rows, frames, problem.mechanism.angles);
}

double length_of(const std::vector<constraint::Row>& rows, Eigen::Index i) { return rows[i].length; }

double largest_of(const VectorX& remaining, const std::vector<constraint::Row>& rows) {
    double most = 0;
    for (Eigen::Index i = 0; i < remaining.size(); ++i) most = std::max(most, std::abs(remaining[i]) * length_of(rows, i));
    return most;
}

}  // namespace

void RowSystem::linearise(const energy::StepProblem& problem, const std::vector<ChartPoint>& points, const std::vector<Pose>& poses,
                          contact::HessianKind kind, kinematics::BlockHessian& hessian) {
    const model::Mechanism& mechanism = problem.model->mechanism;
    const std::vector<measure::PlacedFrame> frames = placed(mechanism.set.frames, poses);
    jacobian_ = row_jacobian(mechanism.set, mechanism.rows, frames);
    std::vector<Vector3> rotation_vectors(points.size());
    std::vector<Matrix3> left_jacobians(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        rotation_vectors[i] = points[i].rotation_vector;
        left_jacobians[i] = kinematics::left_jacobian(rotation_vectors[i]);
    }
    constraint::to_chart(left_jacobians, jacobian_);
    remaining_ = remaining_at(problem, frames);
    unmet_ = remaining_;
    unmet_norm_ = 0;
    for (Eigen::Index i = 0; i < unmet_.size(); ++i) {
        const double gap = std::abs(unmet_[i]) * length_of(mechanism.rows, i);
        if (gap <= met_gap * problem.model->diagonal)
            unmet_[i] = 0;
        else
            unmet_norm_ += gap;
    }
    if (multipliers_.size() != remaining_.size()) multipliers_ = VectorX::Zero(remaining_.size());
    if (kind == contact::HessianKind::exact)
        add_row_curvature(mechanism.set, mechanism.rows, multipliers_, frames, rotation_vectors, hessian);
}

void RowSystem::solve_for_step(const linear::LinearSystem& system, const kinematics::BlockHessian& hessian, const VectorX& r, double drive,
                               std::vector<Vector6>& step) {
    const linear::FreeDofs& dofs = system.dofs();
    for (std::size_t i = 0; i < step.size(); ++i)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[i][k] >= 0) step[i][k] = 0;
    const VectorX wanted = remaining_ - (1 - drive) * unmet_ - multiply(jacobian_, step);
    const linear::LinearSystem::Solution solution = system.solve_refined(hessian, jacobian_, r, wanted, passes_);
    multipliers_ = solution.multipliers;
    scatter(dofs, solution.y, step);
}

std::vector<double> RowSystem::add_forces(const model::Model& model, std::vector<Vector6>& gradient) const {
    std::vector<double> magnitude(gradient.size(), 0.0);
    for (int i = 0; i < jacobian_.count(); ++i)
        for (int k = jacobian_.first[i]; k < jacobian_.first[i + 1]; ++k) {
            const constraint::RowGradient& e = jacobian_.entries[k];
            const auto body = static_cast<std::size_t>(e.body);
            const double arm = std::max(model.bodies[body].radius, model.dhat);
            gradient[body] += multipliers_[i] * e.gradient;
            magnitude[body] += std::abs(multipliers_[i]) * (e.gradient.head<3>().norm() + e.gradient.tail<3>().norm() / arm);
        }
    return magnitude;
}

bool RowSystem::put_on_rows(const energy::StepProblem& problem, const linear::LinearSystem& system, double share,
                            std::vector<ChartPoint>& points) const {
    const model::Mechanism& mechanism = problem.model->mechanism;
    const double size = problem.model->diagonal;
    const VectorX left = share * unmet_, none = VectorX::Zero(system.dofs().count);
    std::vector<Vector6> correction(points.size(), Vector6::Zero());
    double before = 0;
    for (int k = 0; k < most_corrections; ++k) {
        const VectorX remaining = remaining_at(problem, placed(mechanism.set.frames, poses_of(problem, points))) - left;
        const double gap = largest_of(remaining, mechanism.rows);
        if (gap <= rounding_gap * size) return true;
        if (!std::isfinite(gap) || (k > 0 && gap > slow_gain * before)) return gap <= met_gap * size;
        before = gap;
        scatter(system.dofs(), system.solve(none, remaining).y, correction);
        for (std::size_t i = 0; i < points.size(); ++i) {
            points[i].position += correction[i].head<3>();
            points[i].rotation_vector += correction[i].tail<3>();
        }
    }
    return before <= met_gap * size;
}

double largest_gap(const energy::StepProblem& problem, const std::vector<Pose>& poses) {
    const model::Mechanism& mechanism = problem.model->mechanism;
    return largest_of(remaining_at(problem, placed(mechanism.set.frames, poses)), mechanism.rows);
}

}  // namespace fettle::core::solver
