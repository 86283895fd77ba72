// SPDX-License-Identifier: MIT
/// Eigen's dense factorisations of the sizes that fettle needs, compiled once: each costs a file that names it seconds of compiling.
#pragma once

#include <Eigen/Cholesky>
#include <memory>

#include "core/base/types.hpp"

namespace fettle::core::linear {

/// A = vectors diag(values) vectors^T of a symmetric matrix, values ascending.
template <int n>
struct SymmetricEigen {
    Eigen::Matrix<double, n, 1> values;
    Eigen::Matrix<double, n, n> vectors;
};

/// Reads the lower triangle alone. n is 3, 6, 9, 12 or Eigen::Dynamic. Nothing is promised for values that are not finite.
template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix);
/// The values alone: cheaper.
template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(const Eigen::Matrix<double, n, n>& matrix);

/// L D L^T with pivots, of a symmetric matrix. Reads the lower triangle alone.
class SymmetricFactor {
public:
    explicit SymmetricFactor(const Matrix6& matrix);
    Vector6 solve(const Vector6& rhs) const;

private:
    Eigen::LDLT<Matrix6> factor_;
};

/// L U with partial pivoting, of a square matrix. Movable.
class DenseLu {
public:
    DenseLu();
    ~DenseLu();
    DenseLu(DenseLu&&) noexcept;
    DenseLu& operator=(DenseLu&&) noexcept;

    void factorise(const MatrixX& matrix);
    double reciprocal_condition() const;  ///< estimate of 1 / (|A|_1 |A^-1|_1)
    MatrixX solve(const MatrixX& rhs) const;
    MatrixX inverse() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace fettle::core::linear
