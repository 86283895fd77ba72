// SPDX-License-Identifier: MIT
#include "adjoint/constraint/assembly_adjoint.hpp"

#include <algorithm>

#include "core/kinematics/mass_matrix.hpp"
#include "core/linear/linear_system.hpp"

namespace fettle::adjoint::constraint {
namespace {

using core::constraint::AssemblyProblem;
using core::constraint::DependentRow;
using core::constraint::Row;
using core::kinematics::Pose;
using core::measure::PlacedFrame;

Vector6 tangent_of(const Matrix34& bar, const Matrix3& rotation) {
    return core::kinematics::tangent_gradient({bar.col(3), bar.leftCols<3>() * rotation.transpose()});
}

}  // namespace

class AssemblyAdjoint::Implementation {
public:
    Implementation(const AssemblyProblem& problem, const std::vector<DependentRow>& dependent, const std::vector<Pose>& written,
                   const std::vector<Pose>& poses, std::vector<double> angles)
        : problem_(problem),
          written_(written),
          poses_(poses),
          frames_(placed(problem.set.frames, poses)),
          angles_(std::move(angles)),
          solver_(problem.dofs) {
        for (std::size_t i = 0; i < problem.rows.size(); ++i) {
            const auto is_this = [&](const DependentRow& d) { return d.row == static_cast<int>(i); };
            if (std::any_of(dependent.begin(), dependent.end(), is_this)) continue;
            kept_.push_back(static_cast<int>(i));
            rows_.push_back(problem.rows[i]);
        }
        jacobian_ = row_jacobian(problem.set, rows_, frames_);
        find_multipliers();
        solver_.factorise(hessian_, jacobian_);
    }

    AssemblyGradient reverse(const std::vector<Matrix34>& pose_bar) const {
        const std::size_t n = poses_.size();
        std::vector<Vector6> y_bar(n), lambda(n, Vector6::Zero());
        for (std::size_t i = 0; i < n; ++i) y_bar[i] = tangent_of(pose_bar[i], poses_[i].rotation);
        const auto solution = solver_.solve_refined(hessian_, jacobian_, gather(problem_.dofs, y_bar), VectorX::Zero(jacobian_.count()));
        scatter(problem_.dofs, solution.y, lambda);
        AssemblyGradient out;
        out.written_bar = held_back(y_bar, lambda, solution.multipliers);
        out.moments_bar.assign(n, Matrix4::Zero());
        for (std::size_t i = 0; i < n; ++i) {
            Matrix34 v;
            v << cross_matrix(lambda[i].tail<3>()) * poses_[i].rotation, lambda[i].head<3>();
            out.written_bar[i] += tangent_of(v * problem_.moments[i], written_[i].rotation);
            const Matrix4 m = v.transpose() * (pose_matrix(poses_[i]) - pose_matrix(written_[i]));
            out.moments_bar[i] -= 0.5 * (m + m.transpose());
        }
        add_rows(lambda, solution.multipliers, out);
        return out;
    }

private:
    // Those of the inertia's gradient; then the Lagrangian's Hessian.
    void find_multipliers() {
        std::vector<Vector6> gradient;
        std::vector<Matrix3> arms;
        for (std::size_t i = 0; i < poses_.size(); ++i) {
            const Matrix34 g = (pose_matrix(poses_[i]) - pose_matrix(written_[i])) * problem_.moments[i];
            gradient.push_back(tangent_of(g, poses_[i].rotation));
            arms.push_back(g.leftCols<3>() * poses_[i].rotation.transpose());
            hessian_.diagonal.push_back(core::kinematics::mass_matrix(poses_[i].rotation, problem_.moments[i]));
        }
        const std::vector<Vector3> no_turn(poses_.size(), Vector3::Zero());
        add_row_curvature(problem_.set, rows_, VectorX::Zero(jacobian_.count()), frames_, no_turn, hessian_);  // the pattern
        solver_.factorise(hessian_, jacobian_);
        multipliers_ =
            solver_.solve_refined(hessian_, jacobian_, -gather(problem_.dofs, gradient), VectorX::Zero(jacobian_.count())).multipliers;
        for (std::size_t i = 0; i < poses_.size(); ++i)
            hessian_.diagonal[i].bottomRightCorner<3, 3>() += core::kinematics::tangent_curvature(arms[i]);
        add_row_curvature(problem_.set, rows_, multipliers_, frames_, no_turn, hessian_);
    }

    // The gradient in the coordinates that may not move.
    std::vector<Vector6> held_back(const std::vector<Vector6>& y_bar, const std::vector<Vector6>& lambda, const VectorX& mu) const {
        std::vector<Vector6> out(y_bar.size(), Vector6::Zero()), taken = core::linear::multiply(hessian_, lambda);
        add_transposed(jacobian_, mu, taken);
        for (std::size_t i = 0; i < out.size(); ++i)
            for (int k = 0; k < 6; ++k)
                if (problem_.dofs.index[i][k] < 0) out[i][k] = y_bar[i][k] - taken[i][k];
        return out;
    }

    void add_rows(const std::vector<Vector6>& lambda, const VectorX& mu, AssemblyGradient& out) const {
        std::vector<Matrix3> rotations;
        for (const core::measure::Frame& f : problem_.set.frames)
            rotations.push_back(f.body == core::measure::world ? Matrix3(Matrix3::Identity()) : poses_[f.body].rotation);
        out.frames.resize(problem_.set.frames.size());
        out.targets_bar = VectorX::Zero(problem_.rows.size());
        for (const Row& row : problem_.rows) out.factors_bar.emplace_back(row.parts.size(), 0.0);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            out.targets_bar[kept_[i]] += mu[i];
            for (std::size_t k = 0; k < rows_[i].parts.size(); ++k) {
                const core::constraint::RowPart& part = rows_[i].parts[k];
                const core::measure::Measure& m = problem_.set.measures[part.measure];
                const core::measure::VectorFunction f = vector_function(m, frames_);
                Vector12 motion = Vector12::Zero();
                const int a = problem_.set.frames[m.a].body, b = problem_.set.frames[m.b].body;
                if (a != core::measure::world) motion.head<6>() = lambda[a];
                if (b != core::measure::world) motion.tail<6>() = lambda[b];
                const core::measure::PoseGradients g = pose_gradients(m, f, frames_);
                const double change = tangent_gradient(g.a).dot(motion.head<6>()) + tangent_gradient(g.b).dot(motion.tail<6>());
                out.factors_bar[kept_[i]][k] -=
                    multipliers_[i] * change + mu[i] * core::constraint::value_at(problem_.set, part.measure, frames_, angles_);
                add_placement_gradient(f, -part.factor * mu[i], rotations, out.frames);
                add_placement_gradient_of_change(m, f, -part.factor * multipliers_[i], {frames_, rotations}, motion, out.frames);
            }
        }
    }

    const AssemblyProblem& problem_;
    const std::vector<Pose>&written_, &poses_;
    const std::vector<PlacedFrame> frames_;
    const std::vector<double> angles_;
    std::vector<int> kept_;  // places in the problem's rows
    std::vector<Row> rows_;
    core::constraint::RowJacobian jacobian_;
    core::linear::LinearSystem solver_;
    core::kinematics::BlockHessian hessian_;
    VectorX multipliers_;
};

AssemblyAdjoint::AssemblyAdjoint(const AssemblyProblem& problem, const std::vector<DependentRow>& dependent,
                                 const std::vector<Pose>& written, const std::vector<Pose>& assembled, std::vector<double> angles) {
    if (angles.empty()) angles = core::constraint::angles_at(problem.set, assembled, core::constraint::angles_at(problem.set, written, {}));
    implementation_ = std::make_unique<Implementation>(problem, dependent, written, assembled, std::move(angles));
}

AssemblyAdjoint::~AssemblyAdjoint() = default;

AssemblyGradient AssemblyAdjoint::reverse(const std::vector<Matrix34>& pose_bar) const { return implementation_->reverse(pose_bar); }

}  // namespace fettle::adjoint::constraint
