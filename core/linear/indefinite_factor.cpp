// SPDX-License-Identifier: MIT
#include "core/linear/indefinite_factor.hpp"

#include <Eigen/SparseLU>
#include <array>
#include <new>
#include <optional>
#include <variant>

#include "core/base/contract.hpp"
#include "core/linear/factorisations.hpp"

#ifdef FETTLE_SUITESPARSE
#include <umfpack.h>

#include "core/linear/library_threads.hpp"
#endif

namespace fettle::core::linear {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int largest_dense = 96;

Sparse whole_matrix(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int i, int j, double value) {
        if (i >= 0 && j >= 0) entries.emplace_back(i, j, value);
    };
    const auto add_block = [&](int a, int b, const Matrix6& block) {
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) add(dofs.index[a][i], dofs.index[b][j], block(i, j));
    };
    for (std::size_t i = 0; i < hessian.diagonal.size(); ++i) add_block(static_cast<int>(i), static_cast<int>(i), hessian.diagonal[i]);
    for (const OffDiagonalBlock& b : hessian.off_diagonal) {
        add_block(b.a, b.b, b.block);
        add_block(b.b, b.a, b.block.transpose());
    }
    for (int row = 0; row < rows.count(); ++row)
        for (int k = rows.first[row]; k < rows.first[row + 1]; ++k)
            for (int i = 0; i < 6; ++i) {
                const int column = dofs.index[rows.entries[k].body][i];
                add(dofs.count + row, column, rows.entries[k].gradient[i]);
                add(column, dofs.count + row, rows.entries[k].gradient[i]);
            }
    Sparse out(dofs.count + rows.count(), dofs.count + rows.count());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
}

class EigenLu {
public:
    static std::optional<EigenLu> of(const Sparse& matrix) {
        EigenLu out;
        out.lu_->compute(matrix);
        return out.lu_->info() == Eigen::Success ? std::optional(std::move(out)) : std::nullopt;
    }
    MatrixX solve(const MatrixX& rhs) const { return lu_->solve(rhs); }

private:
    std::unique_ptr<Eigen::SparseLU<Sparse>> lu_ = std::make_unique<Eigen::SparseLU<Sparse>>();
};

#ifdef FETTLE_SUITESPARSE

struct Library {
    decltype(&umfpack_di_defaults) defaults = nullptr;
    decltype(&umfpack_di_symbolic) symbolic = nullptr;
    decltype(&umfpack_di_numeric) numeric = nullptr;
    decltype(&umfpack_di_solve) solve = nullptr;
    decltype(&umfpack_di_free_symbolic) free_symbolic = nullptr;
    decltype(&umfpack_di_free_numeric) free_numeric = nullptr;
    LibraryThreads threads;
};

std::optional<Library> load_umfpack() try {
    Library out;
#ifdef FETTLE_UMFPACK_NAME
    const base::SharedLibrary library(FETTLE_UMFPACK_NAME, FETTLE_UMFPACK_PATH);
    library.find("umfpack_di_defaults", out.defaults);
    library.find("umfpack_di_symbolic", out.symbolic);
    library.find("umfpack_di_numeric", out.numeric);
    library.find("umfpack_di_solve", out.solve);
    library.find("umfpack_di_free_symbolic", out.free_symbolic);
    library.find("umfpack_di_free_numeric", out.free_numeric);
    out.threads = threads_of(&library);
#else
    out = {&umfpack_di_defaults,      &umfpack_di_symbolic,     &umfpack_di_numeric, &umfpack_di_solve,
           &umfpack_di_free_symbolic, &umfpack_di_free_numeric, threads_of(nullptr)};
#endif
    return out;
} catch (const base::MissingLibrary&) {
    return std::nullopt;
}

const std::optional<Library>& umfpack() {
    static const std::optional<Library> library = load_umfpack();
    return library;
}

class UmfpackLu {
public:
    static std::optional<UmfpackLu> of(Sparse matrix) {
        UmfpackLu out;
        out.matrix_ = std::move(matrix);
        const Sparse& m = out.matrix_;
        const auto n = static_cast<int>(m.rows());
        std::array<double, UMFPACK_CONTROL> control = settings();
        void* symbolic = nullptr;
        const OneLibraryThread one(umfpack()->threads);
        int status = umfpack()->symbolic(n, n, m.outerIndexPtr(), m.innerIndexPtr(), m.valuePtr(), &symbolic, control.data(), nullptr);
        if (status == UMFPACK_OK) {
            void* numeric = nullptr;
            status = umfpack()->numeric(m.outerIndexPtr(), m.innerIndexPtr(), m.valuePtr(), symbolic, &numeric, control.data(), nullptr);
            out.numeric_.reset(numeric);
        }
        if (symbolic != nullptr) umfpack()->free_symbolic(&symbolic);
        if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
        return status == UMFPACK_OK ? std::optional(std::move(out)) : std::nullopt;
    }

    MatrixX solve(const MatrixX& rhs) const {
        MatrixX x(rhs.rows(), rhs.cols());
        std::array<double, UMFPACK_CONTROL> control = settings();
        const OneLibraryThread one(umfpack()->threads);
        for (Eigen::Index c = 0; c < rhs.cols(); ++c) {
            const int status = umfpack()->solve(UMFPACK_A, matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), matrix_.valuePtr(),
                                                x.col(c).data(), rhs.col(c).data(), numeric_.get(), control.data(), nullptr);
            if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
        }
        return x;
    }

private:
    // Refinement is LinearSystem's.
    static std::array<double, UMFPACK_CONTROL> settings() {
        std::array<double, UMFPACK_CONTROL> control{};
        umfpack()->defaults(control.data());
        control[UMFPACK_IRSTEP] = 0;
        return control;
    }

    struct Free {
        void operator()(void* numeric) const { umfpack()->free_numeric(&numeric); }
    };
    Sparse matrix_;
    std::unique_ptr<void, Free> numeric_;
};

#endif

}  // namespace

struct IndefiniteFactor::Implementation {
#ifdef FETTLE_SUITESPARSE
    std::variant<std::monostate, DenseLu, EigenLu, UmfpackLu> factor;
#else
    std::variant<std::monostate, DenseLu, EigenLu> factor;
#endif

    template <class Factor>
    bool keep(std::optional<Factor> made) {
        if (!made) return false;
        factor = std::move(*made);
        return true;
    }
};

IndefiniteFactor::IndefiniteFactor() : implementation_(std::make_unique<Implementation>()) {}
IndefiniteFactor::~IndefiniteFactor() = default;
IndefiniteFactor::IndefiniteFactor(IndefiniteFactor&&) noexcept = default;
IndefiniteFactor& IndefiniteFactor::operator=(IndefiniteFactor&&) noexcept = default;

bool IndefiniteFactor::factorise(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs) {
    Implementation& self = *implementation_;
    self.factor = std::monostate{};
    Sparse matrix = whole_matrix(hessian, rows, dofs);
    if (matrix.rows() <= largest_dense) {
        DenseLu lu;
        lu.factorise(MatrixX(matrix));
        if (!(lu.reciprocal_condition() > 1e-300)) return false;
        self.factor = std::move(lu);
        return true;
    }
#ifdef FETTLE_SUITESPARSE
    if (umfpack()) return self.keep(UmfpackLu::of(std::move(matrix)));
#endif
    return self.keep(EigenLu::of(matrix));
}

MatrixX IndefiniteFactor::solve(const MatrixX& rhs) const {
    return std::visit(
        [&](const auto& factor) -> MatrixX {
            if constexpr (std::is_same_v<std::decay_t<decltype(factor)>, std::monostate>) {
                FETTLE_ASSERT(false, "solve without a factorisation");
                return {};
            } else {
                return factor.solve(rhs);
            }
        },
        implementation_->factor);
}

}  // namespace fettle::core::linear
