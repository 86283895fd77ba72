// SPDX-License-Identifier: MIT
#include "fettle/design/optimisers/nonnegative_least_squares.hpp"

#include <Eigen/QR>
#include <vector>

namespace fettle::design::optimisers {

namespace {

VectorX solve_passive(const MatrixX& a, const VectorX& b, const std::vector<bool>& passive) {
    std::vector<int> columns;
    for (size_t k = 0; k < passive.size(); ++k) {
        if (passive[k]) columns.push_back(static_cast<int>(k));
    }
    MatrixX part(a.rows(), static_cast<Eigen::Index>(columns.size()));
    for (size_t k = 0; k < columns.size(); ++k) part.col(static_cast<Eigen::Index>(k)) = a.col(columns[k]);
    const VectorX z = part.completeOrthogonalDecomposition().solve(b);
    VectorX x = VectorX::Zero(a.cols());
    for (size_t k = 0; k < columns.size(); ++k) x[columns[k]] = z[static_cast<Eigen::Index>(k)];
    return x;
}

}  // namespace

VectorX nonnegative_least_squares(const MatrixX& a, const VectorX& b) {
    const auto m = static_cast<size_t>(a.cols());
    VectorX x = VectorX::Zero(a.cols());
    std::vector<bool> passive(m, false);
    const double small = 1e-13 * (1 + (a.transpose() * b).cwiseAbs().sum());
    for (size_t round = 0; round < 3 * m + 3; ++round) {
        const VectorX w = a.transpose() * (b - a * x);
        Eigen::Index enter = -1;
        for (Eigen::Index k = 0; k < a.cols(); ++k) {
            if (!passive[static_cast<size_t>(k)] && w[k] > small && (enter < 0 || w[k] > w[enter])) enter = k;
        }
        if (enter < 0) break;
        passive[static_cast<size_t>(enter)] = true;
        for (;;) {
            const VectorX z = solve_passive(a, b, passive);
            double step = 1;
            Eigen::Index leave = -1;
            for (Eigen::Index k = 0; k < a.cols(); ++k) {
                if (!passive[static_cast<size_t>(k)] || z[k] > 0) continue;
                const double reach = x[k] > 0 ? x[k] / (x[k] - z[k]) : 0.0;
                if (leave < 0 || reach < step) {
                    step = reach;
                    leave = k;
                }
            }
            if (leave < 0) {
                x = z;
                break;
            }
            x += step * (z - x);
            x[leave] = 0;
            passive[static_cast<size_t>(leave)] = false;
            x = x.cwiseMax(0);
        }
    }
    return x;
}

}  // namespace fettle::design::optimisers
