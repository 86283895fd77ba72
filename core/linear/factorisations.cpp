// SPDX-License-Identifier: MIT
#include "core/linear/factorisations.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace fettle::core::linear {

template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> eigen(matrix);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(const Eigen::Matrix<double, n, n>& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

template SymmetricEigen<3> symmetric_eigen(const Matrix3&);
template SymmetricEigen<6> symmetric_eigen(const Matrix6&);
template SymmetricEigen<9> symmetric_eigen(const Eigen::Matrix<double, 9, 9>&);
template SymmetricEigen<12> symmetric_eigen(const Matrix12&);
template SymmetricEigen<Eigen::Dynamic> symmetric_eigen(const MatrixX&);
template Vector3 symmetric_eigenvalues(const Matrix3&);
template Vector6 symmetric_eigenvalues(const Matrix6&);
template Vector12 symmetric_eigenvalues(const Matrix12&);
template VectorX symmetric_eigenvalues(const MatrixX&);

SymmetricFactor::SymmetricFactor(const Matrix6& matrix) : factor_(matrix) {}
Vector6 SymmetricFactor::solve(const Vector6& rhs) const { return factor_.solve(rhs); }

struct DenseLu::Implementation {
    Eigen::PartialPivLU<MatrixX> lu;
};

DenseLu::DenseLu() : implementation_(std::make_unique<Implementation>()) {}
DenseLu::~DenseLu() = default;
DenseLu::DenseLu(DenseLu&&) noexcept = default;
DenseLu& DenseLu::operator=(DenseLu&&) noexcept = default;

void DenseLu::factorise(const MatrixX& matrix) { implementation_->lu.compute(matrix); }
double DenseLu::reciprocal_condition() const {
    // Eigen's estimate passes over pivots that are exactly 0.
    return (implementation_->lu.matrixLU().diagonal().array() == 0).any() ? 0 : implementation_->lu.rcond();
}
MatrixX DenseLu::solve(const MatrixX& rhs) const { return implementation_->lu.solve(rhs); }
MatrixX DenseLu::inverse() const { return implementation_->lu.inverse(); }

}  // namespace fettle::core::linear
