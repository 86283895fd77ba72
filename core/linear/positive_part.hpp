// SPDX-License-Identifier: MIT
/// The nearest positive semidefinite matrix: without the curvatures in which a Newton step would go uphill.
#pragma once

#include "core/linear/factorisations.hpp"

namespace fettle::core::linear {

/// V max(D, 0) V^T of V D V^T.
template <int n>
Eigen::Matrix<double, n, n> positive_part(const SymmetricEigen<n>& eigen) {
    const Eigen::Matrix<double, n, 1> positive = eigen.values.cwiseMax(0.0);
    return eigen.vectors * positive.asDiagonal() * eigen.vectors.transpose();
}

}  // namespace fettle::core::linear
