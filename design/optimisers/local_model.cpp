// SPDX-License-Identifier: MIT
#include "design/optimisers/local_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/linear/positive_part.hpp"

namespace fettle::design::optimisers {

namespace {

bool is_first(const Branches& b, size_t k) { return k == 0 || b.of[k] != b.of[k - 1]; }

// Both without the terms of the objective that have branches.
double lagrangian(const Evaluation& e, const VectorX& y) {
    double value = e.objective - y.dot(e.constraints);
    for (size_t k = 0; k < e.objective_branches.of.size(); ++k)
        if (is_first(e.objective_branches, k)) value -= e.objective_branches.values[k];
    return value;
}
Cuts cuts_of(const Evaluator& evaluator, const Evaluation& e) {
    const Branches &rows = e.constraint_branches, &terms = e.objective_branches;
    Cuts cuts;
    cuts.rows.resize(rows.of.size() + terms.of.size(), e.gradient.size());
    cuts.lower.resize(cuts.rows.rows());
    const auto add = [&cuts](int of, double lower, const VectorX& row) {
        const auto at = static_cast<Eigen::Index>(cuts.of.size());
        cuts.rows.row(at) = row.transpose();
        cuts.lower[at] = lower;
        cuts.of.push_back(of);
    };
    for (size_t k = 0; k < rows.of.size(); ++k) {
        const auto j = static_cast<Eigen::Index>(k);
        const int of = rows.of[k];
        if (evaluator.is_greatest(of))
            add(of, rows.values[j] - evaluator.scaled_constraint_upper()[of], -rows.jacobian.row(j).transpose());
        else
            add(of, evaluator.scaled_constraint_lower()[of] - rows.values[j], rows.jacobian.row(j).transpose());
    }
    Eigen::Index first = 0;
    for (size_t k = 0; k < terms.of.size(); ++k) {
        const auto j = static_cast<Eigen::Index>(k);
        if (is_first(terms, k)) {
            first = j;
        } else {
            add(-1 - terms.of[k], terms.values[j] - terms.values[first], (terms.jacobian.row(first) - terms.jacobian.row(j)).transpose());
        }
    }
    cuts.rows.conservativeResize(cuts.of.size(), Eigen::NoChange);
    cuts.lower.conservativeResize(cuts.rows.rows());
    return cuts;
}

// The rows whose cuts are of their upper side change their sign. @return which
std::vector<bool> turn_greatest(const Evaluator& evaluator, QuadraticProgram& program) {
    std::vector<bool> is_turned(static_cast<std::size_t>(program.lower.size()), false);
    for (const int of : program.cuts.of) {
        if (of < 0 || !evaluator.is_greatest(of) || is_turned[of]) continue;
        is_turned[of] = true;
        program.rows.row(of) *= -1;
        std::swap(program.lower[of], program.upper[of]);
        program.lower[of] *= -1;
        program.upper[of] *= -1;
    }
    return is_turned;
}

// The nearest evaluations to a point, it excepted.
std::vector<int> nearest(const Evaluator& evaluator, const VectorX& point) {
    constexpr size_t most = 5;
    constexpr double within = 0.3;
    std::vector<std::pair<double, int>> order;
    for (int k = 0; k < evaluator.known(); ++k) {
        const double distance = evaluator.step_between(point, evaluator.scaled_point(k)).norm();
        if (distance > 0 && distance < within && tells(evaluator.scaled_evaluation(k))) order.emplace_back(distance, k);
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), most));
    std::vector<int> indices;
    indices.reserve(order.size());
    for (const auto& each : order) indices.push_back(each.second);
    return indices;
}

// Replaces the rows of `own` whose linear prediction of the values at the other points is worse than that of `reference`.
// @param changes  others x rows: values there less the value here.  @param steps  others x n.
void choose_rows(const MatrixX& changes, const MatrixX& steps, const MatrixX& reference, MatrixX& own) {
    for (Eigen::Index i = 0; i < own.rows(); ++i) {
        const VectorX by_own = changes.col(i) - steps * own.row(i).transpose();
        const VectorX by_reference = changes.col(i) - steps * reference.row(i).transpose();
        if (by_reference.norm() <= by_own.norm()) own.row(i) = reference.row(i);
    }
}

}  // namespace

VectorX lagrangian_gradient(const Evaluation& e, const VectorX& y) {
    VectorX gradient = e.gradient - e.jacobian.transpose() * y;
    for (size_t k = 0; k < e.objective_branches.of.size(); ++k)
        if (is_first(e.objective_branches, k)) gradient -= e.objective_branches.jacobian.row(k).transpose();
    return gradient;
}

Evaluation with_telling_derivatives(const Evaluator& evaluator, const VectorX& point, const Evaluation& e) {
    const std::optional<Evaluation> reference = evaluator.scaled_reference();
    if (!reference || reference->residuals.size() != e.residuals.size()) return e;
    const std::vector<int> others = nearest(evaluator, point);
    const auto count = static_cast<Eigen::Index>(others.size());
    MatrixX steps(count, point.size()), constraints(count, e.constraints.size()), residuals(count, e.residuals.size());
    for (Eigen::Index k = 0; k < count; ++k) {
        const int other = others[k];
        const VectorX step = evaluator.step_between(point, evaluator.scaled_point(other));
        const double length = step.norm();  // near ones count as much as far ones
        steps.row(k) = step.transpose() / length;
        const Evaluation& there = evaluator.scaled_evaluation(other);
        if (constraints.cols() > 0) constraints.row(k) = (there.constraints - e.constraints).transpose() / length;
        if (residuals.cols() > 0) residuals.row(k) = (there.residuals - e.residuals).transpose() / length;
    }
    Evaluation telling = e;
    const Eigen::Index simulated = evaluator.simulated_constraints();
    MatrixX rows = telling.jacobian.topRows(simulated);
    choose_rows(constraints.leftCols(simulated), steps, reference->jacobian.topRows(simulated), rows);
    telling.jacobian.topRows(simulated) = rows;
    if (e.residuals.size() == 0) return telling;
    choose_rows(residuals, steps, reference->residual_jacobian, telling.residual_jacobian);
    telling.gradient += 2 * (telling.residual_jacobian - e.residual_jacobian).transpose() * e.residuals;
    return telling;
}

MatrixX residual_curvature(const Evaluation& e) {
    const auto n = e.gradient.size();
    if (e.residual_jacobian.rows() == 0) return MatrixX::Zero(n, n);
    return 2 * e.residual_jacobian.transpose() * e.residual_jacobian;
}

void RestCurvature::learn(const Evaluation& from, const VectorX& s, const Evaluation& to, const VectorX& y) {
    const MatrixX known = residual_curvature(to);
    const VectorX rest = lagrangian_gradient(to, y) - lagrangian_gradient(from, y) - known * s - matrix_ * s;
    const double denominator = rest.dot(s);
    if (!(std::abs(denominator) > 1e-8 * rest.norm() * s.norm()) || rest.norm() == 0) return;
    const MatrixX updated = matrix_ + rest * rest.transpose() / denominator;
    // Does it tell the value that was seen at the other end?
    const double seen = lagrangian(from, y) - lagrangian(to, y) + lagrangian_gradient(to, y).dot(s);
    const double with = 0.5 * s.dot((known + updated) * s), without = 0.5 * s.dot((known + matrix_) * s);
    if (std::abs(seen - with) < std::abs(seen - without)) matrix_ = updated;
}

VectorX smooth_multipliers(const QuadraticSolution& solution) {
    VectorX y = solution.multipliers;
    const double size = y.size() > 0 ? y.lpNorm<Eigen::Infinity>() : 0;
    for (size_t j = 0; j < solution.cut_of.size(); ++j)
        if (solution.cut_of[j] >= 0 && std::abs(solution.cut_multipliers[j]) > 1e-6 * size) y[solution.cut_of[j]] = 0;
    return y;
}

VectorX whole_multipliers(const QuadraticSolution& solution) {
    VectorX y = solution.multipliers;
    for (size_t j = 0; j < solution.cut_of.size(); ++j)
        if (solution.cut_of[j] >= 0) y[solution.cut_of[j]] += solution.cut_multipliers[j];
    return y;
}

QuadraticSolution best_step(const Evaluator& evaluator, const VectorX& point, const Evaluation& e, const MatrixX* rest, double radius,
                            double penalty) {
    QuadraticProgram program;
    program.gradient = e.gradient;
    program.hessian = residual_curvature(e);
    if (rest != nullptr) program.hessian = positive_part(core::linear::symmetric_eigen<Eigen::Dynamic>(program.hessian + *rest));
    program.rows = e.jacobian;
    program.lower = evaluator.scaled_constraint_lower() - e.constraints;
    program.upper = evaluator.scaled_constraint_upper() - e.constraints;
    Evaluator::Box box = evaluator.steps_from(point, radius);
    program.box_lower = std::move(box.lower);
    program.box_upper = std::move(box.upper);
    program.penalty = penalty;
    program.cuts = cuts_of(evaluator, e);
    // Cuts are of a row's lower side: rows of values that are the greatest are turned round, and what holds them is turned back.
    const std::vector<bool> is_turned = turn_greatest(evaluator, program);
    QuadraticSolution found = solve(program);
    if (!found.solved) return found;
    for (std::size_t i = 0; i < is_turned.size(); ++i)
        if (is_turned[i]) found.multipliers[static_cast<Eigen::Index>(i)] *= -1;
    for (std::size_t j = 0; j < found.cut_of.size(); ++j)
        if (found.cut_of[j] >= 0 && is_turned[found.cut_of[j]]) found.cut_multipliers[static_cast<Eigen::Index>(j)] *= -1;
    return found;
}

QuadraticSolution restoring_step(const Evaluator& evaluator, const VectorX& point, const Evaluation& e, double radius, double penalty) {
    Evaluation shortest = e;
    shortest.gradient.setZero();
    // In units of what is missed: steps are solved to 1e-9 of numbers of order one.
    const double missed = std::max(target_violation(evaluator, e), 1e-9);
    shortest.residual_jacobian = MatrixX::Identity(point.size(), point.size()) / std::sqrt(missed);
    shortest.objective_branches = {};
    return best_step(evaluator, point, shortest, nullptr, radius, penalty);
}

double target_violation(const Evaluator& evaluator, const Evaluation& e) {
    return row_violation(e.constraints, evaluator.scaled_constraint_lower(), evaluator.scaled_constraint_upper());
}

double merit(const Evaluator& evaluator, const Evaluation& e, double penalty) {
    return e.objective + penalty * target_violation(evaluator, e);
}

}  // namespace fettle::design::optimisers
