// SPDX-License-Identifier: MIT
#include "core/constraint/assembly.hpp"

#include <algorithm>

#include "core/kinematics/mass_matrix.hpp"
#include "core/linear/linear_system.hpp"

namespace fettle::core::constraint {
namespace {

using kinematics::Pose;

constexpr int most_iterations = 200;
constexpr int most_halvings = 24;
constexpr double largest_turn = 0.4;   // of one iteration [rad]
constexpr double largest_shift = 0.2;  // of the scene's size
constexpr double last_step = 1e-14;    // of the scene's size: what is left is rounding

std::vector<Row> kept_rows(const std::vector<Row>& rows, const std::vector<DependentRow>& left_out) {
    std::vector<Row> out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto is_this = [&](const DependentRow& d) { return d.row == static_cast<int>(i); };
        if (std::none_of(left_out.begin(), left_out.end(), is_this)) out.push_back(rows[i]);
    }
    return out;
}

VectorX kept_values(const VectorX& values, const std::vector<DependentRow>& left_out) {
    VectorX out(values.size() - static_cast<Eigen::Index>(left_out.size()));
    Eigen::Index n = 0;
    for (Eigen::Index i = 0; i < values.size(); ++i)
        if (std::none_of(left_out.begin(), left_out.end(), [&](const DependentRow& d) { return d.row == i; })) out[n++] = values[i];
    return out;
}

class Assembler {
public:
    Assembler(const AssemblyProblem& problem, const std::vector<Pose>& start, const std::vector<Pose>& attempt,
              const std::vector<DependentRow>& left_out)
        : problem_(problem),
          start_(start),
          rows_(kept_rows(problem.rows, left_out)),
          targets_(kept_values(problem.targets, left_out)),
          solver_(problem.dofs) {
        at_.poses = attempt;
        at_.angles = angles_at(problem.set, attempt, {});
        measure_gaps(at_);
        multipliers_ = VectorX::Zero(rows_.size());
    }

    // Poses, angles and iterations.
    Assembly run() {
        Assembly out;
        for (; out.iterations < most_iterations; ++out.iterations)
            if (!iterate()) break;
        out.poses = std::move(at_.poses);
        out.angles = std::move(at_.angles);
        return out;
    }

private:
    struct Place {
        std::vector<Pose> poses;
        std::vector<double> angles;
        VectorX remaining;  // target - value, per row
        double gap = 0;     // norm, in lengths
    };

    void measure_gaps(Place& place) const {
        place.remaining = targets_ - row_values(problem_.set, rows_, placed(problem_.set.frames, place.poses), place.angles);
        double square = 0;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const double gap = place.remaining[i] * rows_[i].length;
            square += gap * gap;
        }
        place.gap = std::sqrt(square);
    }

    struct System {
        kinematics::BlockHessian hessian;
        std::vector<Vector6> gradient;
    };

    System inertia() const {
        System out;
        for (std::size_t i = 0; i < start_.size(); ++i) {
            const Matrix34 moved = pose_matrix(at_.poses[i]) - pose_matrix(start_[i]), g = moved * problem_.moments[i];
            const kinematics::PoseGradient gradient{g.col(3), g.leftCols<3>() * at_.poses[i].rotation.transpose()};
            out.gradient.push_back(tangent_gradient(gradient));
            Matrix6 h = kinematics::mass_matrix(at_.poses[i].rotation, problem_.moments[i]);
            if (exact_) h.bottomRightCorner<3, 3>() += kinematics::tangent_curvature(gradient.arm);
            out.hessian.diagonal.push_back(h);
        }
        return out;
    }

    Place moved(const std::vector<Vector6>& step, double fraction) const {
        Place out{at_.poses, {}, {}, 0};
        for (std::size_t i = 0; i < out.poses.size(); ++i) {
            const Vector6 y = fraction * step[i];
            if (y.isZero(0)) continue;
            out.poses[i].position += y.head<3>();
            out.poses[i].rotation = kinematics::orthonormalised(kinematics::rotation(y.tail<3>()) * out.poses[i].rotation);
        }
        out.angles = angles_at(problem_.set, out.poses, at_.angles);
        measure_gaps(out);
        return out;
    }

    // The longest move of a body, as a share of what one iteration may do.
    double stride(const std::vector<Vector6>& step) const {
        double most = 0;
        for (const Vector6& y : step)
            most = std::max({most, y.head<3>().norm() / (largest_shift * problem_.size), y.tail<3>().norm() / largest_turn});
        return most;
    }

    // @return whether to go on.
    bool iterate() {
        const std::vector<measure::PlacedFrame> frames = placed(problem_.set.frames, at_.poses);
        const RowJacobian jacobian = row_jacobian(problem_.set, rows_, frames);
        System system = inertia();
        if (exact_) {
            const std::vector<Vector3> no_turn(start_.size(), Vector3::Zero());
            add_row_curvature(problem_.set, rows_, multipliers_, frames, no_turn, system.hessian);
        }
        if (!solver_.factorise(system.hessian, jacobian)) {
            if (!exact_) return false;
            exact_ = false;
            return true;
        }
        const auto solution = solver_.solve_refined(system.hessian, jacobian, -gather(problem_.dofs, system.gradient), at_.remaining);
        multipliers_ = solution.multipliers;
        std::vector<Vector6> step(start_.size(), Vector6::Zero());
        scatter(problem_.dofs, solution.y, step);
        double fraction = 1 / std::max(1.0, stride(step));
        const double close = closed_gap(problem_.size, start_);
        for (int k = 0; k < most_halvings; ++k, fraction *= 0.5) {
            Place trial = moved(step, fraction);
            if (!(trial.gap <= std::max(close, (1 - 0.1 * fraction) * at_.gap))) continue;
            at_ = std::move(trial);
            exact_ = true;
            return stride(step) > last_step / largest_shift || at_.gap > close;
        }
        if (!exact_) return false;
        exact_ = false;
        return true;
    }

    const AssemblyProblem& problem_;
    const std::vector<Pose>& start_;
    const std::vector<Row> rows_;
    const VectorX targets_;
    linear::LinearSystem solver_;
    Place at_;
    VectorX multipliers_;
    bool exact_ = false;  // with the curvature of rows and rotations
};

std::vector<Matrix6> masses(const AssemblyProblem& problem, const std::vector<Pose>& poses) {
    std::vector<Matrix6> out;
    for (std::size_t i = 0; i < poses.size(); ++i) out.push_back(kinematics::mass_matrix(poses[i].rotation, problem.moments[i]));
    return out;
}

std::vector<DependentRow> dependent_at(const AssemblyProblem& problem, const std::vector<Pose>& poses) {
    const RowJacobian rows = row_jacobian(problem.set, problem.rows, placed(problem.set.frames, poses));
    return dependent_rows(masses(problem, poses), problem.dofs, rows);
}

VectorX gaps_at(const AssemblyProblem& problem, const std::vector<Pose>& poses, const std::vector<double>& angles) {
    VectorX out = (row_values(problem.set, problem.rows, placed(problem.set.frames, poses), angles) - problem.targets).cwiseAbs();
    for (std::size_t i = 0; i < problem.rows.size(); ++i) out[i] *= problem.rows[i].length;
    return out;
}

bool same_rows(const std::vector<DependentRow>& a, const std::vector<DependentRow>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const DependentRow& x, const DependentRow& y) { return x.row == y.row; });
}

}  // namespace

double closed_gap(double size, const std::vector<Pose>& poses) {
    double farthest = 0;
    for (const Pose& pose : poses) farthest = std::max(farthest, pose.position.cwiseAbs().maxCoeff());
    return std::max(1e-12 * size, 16 * std::numeric_limits<double>::epsilon() * farthest);
}

Assembly assemble(const AssemblyProblem& problem, const std::vector<Pose>& start, const std::vector<Pose>& attempt) {
    const double close = closed_gap(problem.size, start);
    const std::vector<Pose>& first = attempt.empty() ? start : attempt;
    Assembly out;
    out.poses = first;
    out.angles = angles_at(problem.set, first, {});
    out.gaps = gaps_at(problem, first, out.angles);
    out.dependent = dependent_at(problem, first);
    out.is_met = !(out.gaps.size() > 0 && out.gaps.maxCoeff() > close);
    if (out.is_met && attempt.empty()) return out;
    constexpr int most_tries = 3;  // which constraints depend on others is known where the bodies fit
    for (int k = 0; k < most_tries; ++k) {
        std::vector<DependentRow> left_out = std::move(out.dependent);
        out = Assembler(problem, start, first, left_out).run();
        out.has_moved = true;
        out.dependent = dependent_at(problem, out.poses);
        out.gaps = gaps_at(problem, out.poses, out.angles);
        out.is_met = out.gaps.maxCoeff() <= close;
        if (out.is_met && same_rows(out.dependent, left_out)) break;
        if (!out.is_met && same_rows(out.dependent, left_out)) break;
    }
    return out;
}

std::vector<Vector6> compatible_velocities(const AssemblyProblem& problem, const std::vector<Pose>& poses,
                                           const std::vector<DependentRow>& dependent, const VectorX& rates,
                                           const std::vector<Vector6>& velocities) {
    const RowJacobian all = row_jacobian(problem.set, problem.rows, placed(problem.set.frames, poses)), rows = without(all, dependent);
    linear::LinearSystem solver(problem.dofs);
    kinematics::BlockHessian hessian;
    hessian.diagonal = masses(problem, poses);
    std::vector<Vector6> out = velocities;
    if (!solver.factorise(hessian, rows)) return out;
    const VectorX none = VectorX::Zero(problem.dofs.count), wanted = kept_values(rates, dependent) - multiply(rows, velocities);
    std::vector<Vector6> change(out.size(), Vector6::Zero());
    scatter(problem.dofs, solver.solve_refined(hessian, rows, none, wanted).y, change);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += change[i];
    return out;
}

}  // namespace fettle::core::constraint
