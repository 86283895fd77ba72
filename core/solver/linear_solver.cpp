// SPDX-License-Identifier: MIT
#include "fettle/core/solver/linear_solver.hpp"

#include <Eigen/SparseCore>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/factorisations.hpp"
#include "fettle/core/solver/block_cholesky.hpp"

namespace fettle::core::solver {
namespace {

constexpr int largest_dense = 96;

// Calls entry(row, column, value) once for each entry of the free part's lower triangle, in a fixed order.
template <class Entry>
void for_each_lower_entry(const kinematics::BlockHessian& hessian, const FreeDofs& dofs, const Entry& entry) {
    for (std::size_t body = 0; body < hessian.diagonal.size(); ++body)
        for (int j = 0; j < 6; ++j)
            for (int i = j; i < 6; ++i) {
                const int row = dofs.index[body][i], column = dofs.index[body][j];
                if (row >= 0 && column >= 0) entry(row, column, hessian.diagonal[body](i, j));
            }
    for (const kinematics::OffDiagonalBlock& b : hessian.off_diagonal)
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) {
                const int row = dofs.index[b.b][j], column = dofs.index[b.a][i];  // a < b: the lower triangle holds block^T
                if (row >= 0 && column >= 0) entry(row, column, b.block(i, j));
            }
}

MatrixX dense_matrix(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
    MatrixX m = MatrixX::Zero(dofs.count, dofs.count);
    for_each_lower_entry(hessian, dofs, [&](int row, int column, double value) { m(row, column) += value; });
    return m;
}

}  // namespace

std::vector<Vector6> multiply(const kinematics::BlockHessian& hessian, const std::vector<Vector6>& v) {
    std::vector<Vector6> out(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) out[i] = hessian.diagonal[i] * v[i];
    for (const kinematics::OffDiagonalBlock& b : hessian.off_diagonal) {
        out[b.a] += b.block * v[b.b];
        out[b.b] += b.block.transpose() * v[b.a];
    }
    return out;
}

struct LinearSolver::Implementation {
    enum class Factor { none, cholesky, dense_lu, sparse_lu };
    FreeDofs dofs;
    Factor factor = Factor::none;
    BlockCholesky cholesky;
    DenseLu dense_lu;
    SparseLu sparse_lu;
};

LinearSolver::LinearSolver(const FreeDofs& dofs) : implementation_(std::make_unique<Implementation>()) { implementation_->dofs = dofs; }
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;

bool LinearSolver::factorise(const kinematics::BlockHessian& hessian) {
    Implementation& self = *implementation_;
    self.factor = Implementation::Factor::none;
    if (!self.cholesky.factorise(hessian, self.dofs)) return false;
    self.factor = Implementation::Factor::cholesky;
    return true;
}

bool LinearSolver::factorise_indefinite(const kinematics::BlockHessian& hessian) {
    if (factorise(hessian)) return true;
    Implementation& self = *implementation_;
    if (self.dofs.count <= largest_dense) {
        const MatrixX lower = dense_matrix(hessian, self.dofs);
        self.dense_lu.factorise(lower.selfadjointView<Eigen::Lower>());
        if (!(self.dense_lu.reciprocal_condition() > 1e-300)) return false;
        self.factor = Implementation::Factor::dense_lu;
        return true;
    }
    std::vector<Eigen::Triplet<double>> entries;
    for_each_lower_entry(hessian, self.dofs, [&](int row, int column, double value) {
        entries.emplace_back(row, column, value);
        if (row != column) entries.emplace_back(column, row, value);
    });
    Eigen::SparseMatrix<double> matrix(self.dofs.count, self.dofs.count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (!self.sparse_lu.factorise(matrix)) return false;
    self.factor = Implementation::Factor::sparse_lu;
    return true;
}

MatrixX LinearSolver::solve(const MatrixX& rhs) const {
    Implementation& self = *implementation_;
    using Factor = Implementation::Factor;
    if (rhs.size() == 0) return rhs;
    switch (self.factor) {
        case Factor::cholesky:
            return self.cholesky.solve(rhs, self.dofs);
        case Factor::dense_lu:
            return self.dense_lu.solve(rhs);
        case Factor::sparse_lu:
            return self.sparse_lu.solve(rhs);
        case Factor::none:
            break;
    }
    FETTLE_ASSERT(false, "solve without a factorisation");
    return {};
}

}  // namespace fettle::core::solver
