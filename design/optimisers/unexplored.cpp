// SPDX-License-Identifier: MIT
#include "design/optimisers/unexplored.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::design::optimisers {

namespace {

constexpr double kept = 0.1;    // of a row's slope
constexpr double known = 0.03;  // of the ranges

// The eigenvectors of a positive semi-definite matrix whose values are below a limit, the least first; n x any.
MatrixX least_of(const MatrixX& matrix, double below) {
    const core::linear::SymmetricEigen<Eigen::Dynamic> eigen = core::linear::symmetric_eigen<Eigen::Dynamic>(matrix);
    std::vector<Eigen::Index> order;
    for (Eigen::Index k = 0; k < eigen.values.size(); ++k)
        if (eigen.values[k] < below) order.push_back(k);
    std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return eigen.values[a] < eigen.values[b]; });
    MatrixX out(matrix.rows(), count_of(order));
    for (Eigen::Index k = 0; k < out.cols(); ++k) out.col(k) = eigen.vectors.col(order[k]);
    return out;
}

}  // namespace

MatrixX free_directions(const MatrixX& holding) {
    const MatrixX rows = holding.rowwise().normalized();
    return least_of(rows.transpose() * rows, kept * kept);
}

std::vector<VectorX> unexplored_directions(const MatrixX& holding, const MatrixX& steps, int most) {
    FETTLE_ASSERT(holding.cols() == steps.cols(), "rows and steps are of the same variables");
    const MatrixX free = free_directions(holding);
    std::vector<VectorX> directions;
    if (free.cols() == 0) return directions;
    const MatrixX reached = steps * free;
    const MatrixX along = free * least_of(reached.transpose() * reached, known * known);
    for (Eigen::Index k = 0; k < along.cols() && count_of(directions) < most; ++k) directions.push_back(along.col(k));
    return directions;
}

}  // namespace fettle::design::optimisers
