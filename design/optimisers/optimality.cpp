// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/optimality.hpp"

#include <limits>
#include <vector>

#include "fettle/design/optimisers/nonnegative_least_squares.hpp"

namespace fettle::design::optimisers {

double optimality_residual(const Evaluator& evaluator, const VectorX& x, const Evaluation& e, double active) {
    if (!e.usable) return std::numeric_limits<double>::infinity();
    std::vector<VectorX> normals;
    for (int i = 0; i < x.size(); ++i) {
        const VectorX unit = VectorX::Unit(x.size(), i);
        if (x[i] <= active) normals.push_back(unit);
        if (x[i] >= 1 - active) normals.push_back(-unit);
    }
    for (int i = 0; i < evaluator.constraints(); ++i) {
        const VectorX row = e.jacobian.row(i).transpose();
        if (e.constraints[i] <= evaluator.scaled_constraint_lower()[i] + active) normals.push_back(row);
        if (e.constraints[i] >= evaluator.scaled_constraint_upper()[i] - active) normals.push_back(-row);
    }
    if (normals.empty()) return e.gradient.size() > 0 ? e.gradient.lpNorm<Eigen::Infinity>() : 0.0;
    MatrixX a(x.size(), static_cast<Eigen::Index>(normals.size()));
    for (size_t k = 0; k < normals.size(); ++k) a.col(static_cast<Eigen::Index>(k)) = normals[k];
    const VectorX multipliers = nonnegative_least_squares(a, e.gradient);
    return (a * multipliers - e.gradient).lpNorm<Eigen::Infinity>();
}

}  // namespace fettle::design::optimisers
