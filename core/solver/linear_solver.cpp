// SPDX-License-Identifier: MIT
#include "fettle/core/solver/linear_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <algorithm>
#include <functional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/solver/cholmod_library.hpp"

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

// CHOLMOD's handles, freed together.
class SparseCholesky {
public:
    SparseCholesky() = default;
    ~SparseCholesky() {
        if (cholmod_ == nullptr) return;
        release();
        cholmod_->finish(&common_);
    }
    SparseCholesky(const SparseCholesky&) = delete;
    SparseCholesky& operator=(const SparseCholesky&) = delete;

    bool factorise(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
        start();
        update_pattern(hessian, dofs);
        double* values = static_cast<double*>(matrix_->x);
        std::fill(values, values + position_count_, 0.0);
        std::size_t k = 0;
        for_each_lower_entry(hessian, dofs, [&](int, int, double value) { values[position_[k++]] += value; });
        common_.status = CHOLMOD_OK;
        cholmod_->factorize(matrix_, factor_, &common_);
        return common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
    }

    MatrixX solve(const MatrixX& rhs) {
        MatrixX out(rhs.rows(), rhs.cols());
        cholmod_dense b{};
        b.nrow = b.d = static_cast<std::size_t>(rhs.rows());
        b.ncol = static_cast<std::size_t>(rhs.cols());
        b.nzmax = b.nrow * b.ncol;
        b.x = const_cast<double*>(rhs.data());
        b.xtype = CHOLMOD_REAL;
        b.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* x = cholmod_->solve(CHOLMOD_A, factor_, &b, &common_);
        FETTLE_ASSERT(x != nullptr, "CHOLMOD could not solve");
        std::copy_n(static_cast<const double*>(x->x), out.size(), out.data());
        cholmod_->free_dense(&x, &common_);
        return out;
    }

private:
    // CHOLMOD is loaded for the first matrix: small systems do without.
    void start() {
        if (cholmod_ != nullptr) return;
        const CholmodLibrary& library = cholmod_library();
        library.start(&common_);
        cholmod_ = &library;
        common_.supernodal = CHOLMOD_SIMPLICIAL;
        common_.final_ll = 1;
        common_.quick_return_if_not_posdef = 1;
        common_.print = 0;
    }

    void release() {
        if (factor_) cholmod_->free_factor(&factor_, &common_);
        if (matrix_) cholmod_->free_sparse(&matrix_, &common_);
    }

    // The symbolic factor depends on which bodies touch; it is kept while that does not change.
    void update_pattern(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
        std::vector<std::pair<int, int>> pattern;
        for (const auto& b : hessian.off_diagonal) pattern.emplace_back(b.a, b.b);
        if (matrix_ && pattern == pattern_) return;
        pattern_ = std::move(pattern);
        release();
        FETTLE_ASSERT(std::adjacent_find(pattern_.begin(), pattern_.end(), std::greater_equal<>()) == pattern_.end(),
                      "blocks out of order");
        // Blocks come by columns, then rows, so each column's entries come in order: count them, then put each behind the one before.
        const auto n = static_cast<std::size_t>(dofs.count);
        std::vector<int> next(n + 1, 0);
        position_count_ = 0;
        for_each_lower_entry(hessian, dofs, [&](int, int column, double) {
            ++next[static_cast<std::size_t>(column) + 1];
            ++position_count_;
        });
        matrix_ = cholmod_->allocate_sparse(n, n, std::max<std::size_t>(1, position_count_), 1, 1, -1, CHOLMOD_REAL, &common_);
        FETTLE_ASSERT(matrix_ != nullptr, "CHOLMOD is out of memory");
        for (std::size_t j = 0; j < n; ++j) next[j + 1] += next[j];
        std::copy(next.begin(), next.end(), static_cast<int*>(matrix_->p));
        int* rows = static_cast<int*>(matrix_->i);
        position_.clear();
        for_each_lower_entry(hessian, dofs, [&](int row, int column, double) {
            int& at = next[static_cast<std::size_t>(column)];
            rows[at] = row;
            position_.push_back(static_cast<std::size_t>(at++));
        });
        factor_ = cholmod_->analyze(matrix_, &common_);
        FETTLE_ASSERT(factor_ != nullptr, "CHOLMOD could not analyse the Hessian");
    }

    const CholmodLibrary* cholmod_ = nullptr;  // once it is started
    cholmod_common common_{};
    cholmod_sparse* matrix_ = nullptr;
    cholmod_factor* factor_ = nullptr;
    std::vector<std::pair<int, int>> pattern_;
    std::vector<std::size_t> position_;  // of each visited entry in the matrix
    std::size_t position_count_ = 0;
};

}  // namespace

FreeDofs free_dofs(const model::Model& model) {
    FreeDofs dofs;
    for (const model::Body& body : model.bodies) {
        std::array<int, 6> index;
        for (int k = 0; k < 6; ++k) index[k] = model::is_free(body, k) ? dofs.count++ : -1;
        dofs.index.push_back(index);
    }
    return dofs;
}

VectorX gather(const FreeDofs& dofs, const std::vector<Vector6>& values) {
    VectorX out(dofs.count);
    for (std::size_t body = 0; body < values.size(); ++body)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[body][k] >= 0) out[dofs.index[body][k]] = values[body][k];
    return out;
}

void scatter(const FreeDofs& dofs, const VectorX& free_values, std::vector<Vector6>& values) {
    for (std::size_t body = 0; body < values.size(); ++body)
        for (int k = 0; k < 6; ++k)
            if (dofs.index[body][k] >= 0) values[body][k] = free_values[dofs.index[body][k]];
}

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
    enum class Factor { none, dense_cholesky, dense_lu, sparse_cholesky, sparse_lu };
    FreeDofs dofs;
    Factor factor = Factor::none;
    Eigen::LLT<MatrixX> dense_cholesky;
    Eigen::PartialPivLU<MatrixX> dense_lu;
    SparseCholesky sparse_cholesky;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu;
};

LinearSolver::LinearSolver(const FreeDofs& dofs) : implementation_(std::make_unique<Implementation>()) { implementation_->dofs = dofs; }
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;

bool LinearSolver::factorise(const kinematics::BlockHessian& hessian) {
    Implementation& self = *implementation_;
    self.factor = Implementation::Factor::none;
    if (self.dofs.count <= largest_dense) {
        self.dense_cholesky.compute(dense_matrix(hessian, self.dofs));
        if (self.dense_cholesky.info() != Eigen::Success) return false;
        self.factor = Implementation::Factor::dense_cholesky;
        return true;
    }
    if (!self.sparse_cholesky.factorise(hessian, self.dofs)) return false;
    self.factor = Implementation::Factor::sparse_cholesky;
    return true;
}

bool LinearSolver::factorise_indefinite(const kinematics::BlockHessian& hessian) {
    if (factorise(hessian)) return true;
    Implementation& self = *implementation_;
    if (self.dofs.count <= largest_dense) {
        const MatrixX lower = dense_matrix(hessian, self.dofs);
        self.dense_lu.compute(lower.selfadjointView<Eigen::Lower>());
        if (!(self.dense_lu.rcond() > 1e-300)) return false;
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
    self.sparse_lu.compute(matrix);
    if (self.sparse_lu.info() != Eigen::Success) return false;
    self.factor = Implementation::Factor::sparse_lu;
    return true;
}

MatrixX LinearSolver::solve(const MatrixX& rhs) const {
    Implementation& self = *implementation_;
    using Factor = Implementation::Factor;
    if (rhs.size() == 0) return rhs;
    switch (self.factor) {
        case Factor::dense_cholesky:
            return self.dense_cholesky.solve(rhs);
        case Factor::dense_lu:
            return self.dense_lu.solve(rhs);
        case Factor::sparse_cholesky:
            return self.sparse_cholesky.solve(rhs);
        case Factor::sparse_lu:
            return self.sparse_lu.solve(rhs);
        case Factor::none:
            break;
    }
    FETTLE_ASSERT(false, "solve without a factorisation");
    return {};
}

}  // namespace fettle::core::solver
