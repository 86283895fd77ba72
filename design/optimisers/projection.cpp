// SPDX-License-Identifier: MIT
#include "design/optimisers/projection.hpp"

#include <algorithm>
#include <cmath>

#include "design/optimisers/quadratic_program.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr int most_points = 20;
constexpr double settled = 1e-9;  // of the variables' ranges

}  // namespace

VectorX project(const VectorX& start, const CheapConstraints& constraints) {
    const VectorX range = (constraints.upper - constraints.lower).unaryExpr([](double r) { return r > 0 ? r : 1.0; });
    VectorX x = start;
    std::optional<Rows> rows = constraints.rows(x);
    for (int k = 0; k < most_points && rows && rows->values.size() > 0; ++k) {
        VectorX scale = (rows->jacobian * range.asDiagonal()).rowwise().lpNorm<Eigen::Infinity>();
        scale = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 1.0; });
        QuadraticProgram program;
        program.gradient = 2 * (x - start).cwiseQuotient(range);
        program.hessian = 2 * MatrixX::Identity(x.size(), x.size());
        program.rows = scale.asDiagonal() * rows->jacobian * range.asDiagonal();
        program.lower = scale.cwiseProduct(constraints.row_lower - rows->values);
        program.upper = scale.cwiseProduct(constraints.row_upper - rows->values);
        program.box_lower = (constraints.lower - x).cwiseQuotient(range).cwiseMin(0);
        program.box_upper = (constraints.upper - x).cwiseQuotient(range).cwiseMax(0);
        program.penalty = 100;  // far above what a unit of the ranges costs
        const QuadraticSolution solution = solve(program);
        if (!solution.solved || solution.step.lpNorm<Eigen::Infinity>() < settled) break;
        const VectorX next = (x + solution.step.cwiseProduct(range)).cwiseMax(constraints.lower).cwiseMin(constraints.upper);
        std::optional<Rows> there = constraints.rows(next);
        if (!there) break;
        x = next;
        rows = std::move(there);
    }
    return x;
}

}  // namespace fettle::design::optimisers
