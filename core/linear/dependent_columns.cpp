// SPDX-License-Identifier: MIT
#include "core/linear/dependent_columns.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseQR>
#include <algorithm>
#include <new>
#include <optional>

#ifdef FETTLE_SUITESPARSE
#include <SuiteSparseQR_C.h>

#include "core/linear/library_threads.hpp"
#endif

namespace fettle::core::linear {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// R, upper trapezoidal: the first `rank` of its columns are independent. [column of R] which of the matrix it is
struct RankFactor {
    Sparse r;
    std::vector<int> columns;
    int rank = 0;
};

RankFactor factor_by_eigen(const Sparse& matrix, double share) {
    Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
    qr.setPivotThreshold(share);
    qr.compute(matrix);
    const auto& indices = qr.colsPermutation().indices();
    return {qr.matrixR(), {indices.data(), indices.data() + indices.size()}, static_cast<int>(qr.rank())};
}

#ifdef FETTLE_SUITESPARSE

struct Library {
    decltype(&SuiteSparseQR_C) factorise = nullptr;
    decltype(&cholmod_l_start) start = nullptr;
    decltype(&cholmod_l_finish) finish = nullptr;
    decltype(&cholmod_l_free_sparse) free_sparse = nullptr;
    decltype(&cholmod_l_free) free = nullptr;
    LibraryThreads threads;
};

std::optional<Library> load_spqr() try {
    Library out;
#ifdef FETTLE_SPQR_NAME
    const base::SharedLibrary library(FETTLE_SPQR_NAME, FETTLE_SPQR_PATH);
    library.find("SuiteSparseQR_C", out.factorise);
    library.find("cholmod_l_start", out.start);
    library.find("cholmod_l_finish", out.finish);
    library.find("cholmod_l_free_sparse", out.free_sparse);
    library.find("cholmod_l_free", out.free);
    out.threads = threads_of(&library);
#else
    out = {&SuiteSparseQR_C, &cholmod_l_start, &cholmod_l_finish, &cholmod_l_free_sparse, &cholmod_l_free, threads_of(nullptr)};
#endif
    return out;
} catch (const base::MissingLibrary&) {
    return std::nullopt;
}

const std::optional<Library>& spqr() {
    static const std::optional<Library> library = load_spqr();
    return library;
}

RankFactor factor_by_spqr(const Sparse& matrix, double share) {
    const Library& library = *spqr();
    cholmod_common common;
    library.start(&common);
    common.print = 0;
    common.try_catch = 1;
    std::vector<SuiteSparse_long> starts(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1),
        rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    std::vector<double> values(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(matrix.rows());
    view.ncol = static_cast<std::size_t>(matrix.cols());
    view.nzmax = rows.size();
    view.p = starts.data();
    view.i = rows.data();
    view.x = values.data();
    view.itype = CHOLMOD_LONG;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    const OneLibraryThread one(library.threads);
    cholmod_sparse* r = nullptr;
    SuiteSparse_long* order = nullptr;
    const SuiteSparse_long rank = library.factorise(SPQR_ORDERING_DEFAULT, share, 0, 0, &view, nullptr, nullptr, nullptr, nullptr, &r,
                                                    &order, nullptr, nullptr, nullptr, &common);
    RankFactor out;
    if (r != nullptr) {
        const auto *p = static_cast<const SuiteSparse_long*>(r->p), *i = static_cast<const SuiteSparse_long*>(r->i);
        std::vector<Eigen::Triplet<double>> entries;
        for (SuiteSparse_long j = 0; j < static_cast<SuiteSparse_long>(r->ncol); ++j)
            for (SuiteSparse_long k = p[j]; k < p[j + 1]; ++k)
                entries.emplace_back(static_cast<int>(i[k]), static_cast<int>(j), static_cast<const double*>(r->x)[k]);
        out.r.resize(r->nrow, r->ncol);
        out.r.setFromTriplets(entries.begin(), entries.end());
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) out.columns.push_back(static_cast<int>(order != nullptr ? order[j] : j));
        out.rank = static_cast<int>(rank);
    }
    library.free_sparse(&r, &common);
    library.free(static_cast<std::size_t>(matrix.cols()), sizeof(SuiteSparse_long), order, &common);
    const bool has_failed = out.columns.empty();
    library.finish(&common);
    if (has_failed) throw std::bad_alloc();
    return out;
}

#endif

RankFactor factorise(const Sparse& matrix, double share) {
#ifdef FETTLE_SUITESPARSE
    if (spqr()) return factor_by_spqr(matrix, share);
#endif
    return factor_by_eigen(matrix, share);
}

// The least remainder of the columns that are kept, each with those before it taken out.
double least_left(const RankFactor& factor) {
    double least = 1;
    for (int i = 0; i < factor.rank; ++i) least = std::min(least, std::abs(factor.r.coeff(i, i)));
    return least;
}

// Where columns that are kept nearly depend on one another: as many that do less so, by powers of ten, if the order allows it.
RankFactor factorise_well(const Sparse& matrix, double share) {
    constexpr double nearly = 1e-3;
    RankFactor out = factorise(matrix, share);
    const double least = least_left(out);
    if (out.rank == matrix.cols() || least > nearly) return out;
    for (double apart = 1e-2; apart > least; apart *= 0.1) {
        RankFactor better = factorise(matrix, apart);
        if (better.rank == out.rank) return better;
    }
    return out;
}

}  // namespace

std::vector<DependentColumn> dependent_columns(Sparse matrix, double share) {
    constexpr double counts = 1e-6;  // of the largest part
    matrix.makeCompressed();
    std::vector<DependentColumn> out;
    if (matrix.nonZeros() == 0) {  // each is a sum of nothing
        for (int j = 0; j < matrix.cols(); ++j) out.push_back({j, {}});
        return out;
    }
    VectorX lengths(matrix.cols());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        lengths[j] = matrix.col(j).norm();
        if (lengths[j] > 0) matrix.col(j) /= lengths[j];
    }
    const RankFactor factor = factorise_well(matrix, share);
    const Sparse independent = factor.r.topLeftCorner(factor.rank, factor.rank);
    for (Eigen::Index j = factor.rank; j < matrix.cols(); ++j) {
        DependentColumn& dependent = out.emplace_back();
        dependent.column = factor.columns[j];
        VectorX parts = VectorX(factor.r.col(j)).head(factor.rank);
        independent.triangularView<Eigen::Upper>().solveInPlace(parts);
        for (Eigen::Index i = 0; i < factor.rank; ++i) parts[i] /= lengths[factor.columns[i]];
        const double largest = factor.rank > 0 ? parts.cwiseAbs().maxCoeff() : 0;
        for (Eigen::Index i = 0; i < factor.rank; ++i)
            if (std::abs(parts[i]) > counts * largest) dependent.on.push_back(factor.columns[i]);
        std::sort(dependent.on.begin(), dependent.on.end());
    }
    std::sort(out.begin(), out.end(), [](const DependentColumn& a, const DependentColumn& b) { return a.column < b.column; });
    return out;
}

}  // namespace fettle::core::linear
