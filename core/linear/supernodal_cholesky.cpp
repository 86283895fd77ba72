// SPDX-License-Identifier: MIT
#include "core/linear/supernodal_cholesky.hpp"

#include "core/base/contract.hpp"

#ifdef FETTLE_SUITESPARSE

#include <cholmod.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <optional>

#include "core/linear/library_threads.hpp"

namespace fettle::core::linear {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// Each is called CHOLMOD(x) with its name, without its "cholmod_".
#define FETTLE_CHOLMOD_FUNCTIONS(CHOLMOD) \
    CHOLMOD(start)                        \
    CHOLMOD(finish) CHOLMOD(nested_dissection) CHOLMOD(analyze_p) CHOLMOD(factorize) CHOLMOD(solve) CHOLMOD(free_factor) CHOLMOD(free_dense)

struct Library {
#define FETTLE_CHOLMOD_MEMBER(function) decltype(&cholmod_##function) function = nullptr;
    FETTLE_CHOLMOD_FUNCTIONS(FETTLE_CHOLMOD_MEMBER)
#undef FETTLE_CHOLMOD_MEMBER
    LibraryThreads threads;
};

std::optional<Library> load() try {
    Library out;
#ifdef FETTLE_CHOLMOD_NAME
    const base::SharedLibrary library(FETTLE_CHOLMOD_NAME, FETTLE_CHOLMOD_PATH);
    out.threads = threads_of(&library);
#define FETTLE_CHOLMOD_FIND(function) library.find("cholmod_" #function, out.function);
#else
    out.threads = threads_of(nullptr);
#define FETTLE_CHOLMOD_FIND(function) out.function = &cholmod_##function;
#endif
    FETTLE_CHOLMOD_FUNCTIONS(FETTLE_CHOLMOD_FIND)
#undef FETTLE_CHOLMOD_FIND
    if (out.threads.set_blas == nullptr) return std::nullopt;
    return out;
} catch (const base::MissingLibrary&) {
    return std::nullopt;
}

const std::optional<Library>& cholmod() {
    static const std::optional<Library> library = load();
    return library;
}

// METIS draws numbers from the C library's generator, which starts anew with every call but is the whole program's.
std::mutex& one_dissection() {
    static std::mutex mutex;
    return mutex;
}

// A matrix whose numbers and indices are in vectors; [column] .. of the lower triangle.
struct Lower {
    std::vector<int> starts, rows;
    std::vector<double> values;

    cholmod_sparse view() {
        cholmod_sparse out{};
        out.nrow = out.ncol = starts.size() - 1;
        out.nzmax = rows.size();
        out.p = starts.data();
        out.i = rows.data();
        out.x = values.empty() ? nullptr : values.data();
        out.stype = -1;
        out.itype = CHOLMOD_INT;
        out.xtype = values.empty() ? CHOLMOD_PATTERN : CHOLMOD_REAL;
        out.dtype = CHOLMOD_DOUBLE;
        out.sorted = out.packed = 1;
        return out;
    }
};

// Calls entry(row, column, value) for each entry of the lower triangle of the free part, column by column, rows ascending.
template <class Entry>
void for_each_lower_entry(const BlockHessian& hessian, const FreeDofs& dofs, const Entry& entry) {
    auto next = hessian.off_diagonal.begin();
    for (std::size_t body = 0; body < hessian.diagonal.size(); ++body) {
        const auto first = next;
        while (next != hessian.off_diagonal.end() && next->a == static_cast<int>(body)) ++next;
        for (int j = 0; j < 6; ++j) {
            const int column = dofs.index[body][at(j)];
            if (column < 0) continue;
            for (int i = j; i < 6; ++i)
                if (dofs.index[body][at(i)] >= 0) entry(dofs.index[body][at(i)], column, hessian.diagonal[body](i, j));
            for (auto b = first; b != next; ++b)
                for (int i = 0; i < 6; ++i)
                    if (dofs.index[at(b->b)][at(i)] >= 0) entry(dofs.index[at(b->b)][at(i)], column, b->block(j, i));
        }
    }
}

// The graph of the bodies in `order`, numbered by their place in it.
Lower graph_of(const BlockHessian& hessian, const FreeDofs& dofs, const std::vector<int>& order) {
    std::vector<int> place(dofs.index.size(), -1);
    for (std::size_t k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<int>(k);
    std::vector<std::vector<int>> columns(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) columns[k].push_back(static_cast<int>(k));
    for (const OffDiagonalBlock& b : hessian.off_diagonal) {
        const int i = place[at(b.a)], j = place[at(b.b)];
        if (i >= 0 && j >= 0) columns[at(std::min(i, j))].push_back(std::max(i, j));
    }
    Lower out;
    for (std::vector<int>& column : columns) {
        std::sort(column.begin(), column.end());
        out.starts.push_back(count_of(out.rows));
        out.rows.insert(out.rows.end(), column.begin(), column.end());
    }
    out.starts.push_back(count_of(out.rows));
    return out;
}

}  // namespace

struct SupernodalCholesky::Implementation {
    cholmod_common common;
    Lower matrix;
    cholmod_factor* factor = nullptr;

    Implementation() {
        FETTLE_ASSERT(cholmod().has_value(), "CHOLMOD is not there");
        cholmod()->start(&common);
        common.print = 0;
        common.try_catch = 1;
        common.quick_return_if_not_posdef = 1;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.final_ll = 1;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        common.method[0].nd_small = 20;  // bodies, not numbers: a part of so few is dissected no further
        common.postorder = 1;
        for (std::size_t k = 0; k < 3; ++k) common.nrelax[k] *= 6;  // columns of a body come together
    }
    ~Implementation() {
        cholmod()->free_factor(&factor, &common);
        cholmod()->finish(&common);
    }
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    void check_memory() const {
        if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
    }

    // The order of the bodies by dissection; empty: this CHOLMOD dissects nothing.
    std::vector<int> dissected(const BlockHessian& hessian, const FreeDofs& dofs, const std::vector<int>& bodies) {
        Lower graph = graph_of(hessian, dofs, bodies);
        cholmod_sparse view = graph.view();
        std::vector<int> order(bodies.size()), parents(bodies.size()), members(bodies.size());
        const std::lock_guard lock(one_dissection());
        const auto parts = cholmod()->nested_dissection(&view, nullptr, 0, order.data(), parents.data(), members.data(), &common);
        check_memory();
        if (parts < 0) return {};
        for (int& k : order) k = bodies[at(k)];
        return order;
    }

    void analyse_in(const std::vector<int>& bodies, const FreeDofs& dofs) {
        std::vector<int> order;
        for (const int body : bodies)
            for (const int k : dofs.index[at(body)])
                if (k >= 0) order.push_back(k);
        cholmod_sparse view = matrix.view();
        cholmod()->free_factor(&factor, &common);
        factor = cholmod()->analyze_p(&view, order.data(), nullptr, 0, &common);
        check_memory();
        FETTLE_ASSERT(factor != nullptr, "CHOLMOD refused a matrix");
    }
};

SupernodalCholesky::SupernodalCholesky() = default;
SupernodalCholesky::~SupernodalCholesky() = default;
SupernodalCholesky::SupernodalCholesky(SupernodalCholesky&&) noexcept = default;
SupernodalCholesky& SupernodalCholesky::operator=(SupernodalCholesky&&) noexcept = default;

bool SupernodalCholesky::is_available() { return cholmod().has_value(); }

void SupernodalCholesky::analyse(const BlockHessian& hessian, const FreeDofs& dofs, const std::vector<int>& order, double operations) {
    if (!implementation_) implementation_ = std::make_unique<Implementation>();
    Implementation& self = *implementation_;
    Lower& matrix = self.matrix;
    matrix = {};
    for_each_lower_entry(hessian, dofs, [&](int row, int column, double) {
        if (column == count_of(matrix.starts)) matrix.starts.push_back(count_of(matrix.rows));
        matrix.rows.push_back(row);
    });
    matrix.starts.push_back(count_of(matrix.rows));
    matrix.values.resize(matrix.rows.size());
    const OneLibraryThread one(cholmod()->threads);
    const std::vector<int> dissected = self.dissected(hessian, dofs, order);
    if (!dissected.empty()) {
        self.analyse_in(dissected, dofs);
        if (self.common.fl <= operations) return;
    }
    self.analyse_in(order, dofs);
}

bool SupernodalCholesky::factorise(const BlockHessian& hessian, const FreeDofs& dofs) {
    Implementation& self = *implementation_;
    double* next = self.matrix.values.data();
    for_each_lower_entry(hessian, dofs, [&](int, int, double value) { *next++ = value; });
    cholmod_sparse view = self.matrix.view();
    const OneLibraryThread one(cholmod()->threads);
    cholmod()->factorize(&view, self.factor, &self.common);
    self.check_memory();
    if (self.common.status != CHOLMOD_OK || self.factor->minor < self.factor->n) return false;
    // OpenBLAS's factor of a panel takes what is no number for positive.
    return Eigen::Map<const VectorX>(static_cast<const double*>(self.factor->x), self.factor->xsize).allFinite();
}

MatrixX SupernodalCholesky::solve(const MatrixX& rhs) const {
    Implementation& self = *implementation_;
    MatrixX copy = rhs;
    cholmod_dense view{};
    view.nrow = view.d = static_cast<std::size_t>(copy.rows());
    view.ncol = static_cast<std::size_t>(copy.cols());
    view.nzmax = static_cast<std::size_t>(copy.size());
    view.x = copy.data();
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    const OneLibraryThread one(cholmod()->threads);
    cholmod_dense* x = cholmod()->solve(CHOLMOD_A, self.factor, &view, &self.common);
    self.check_memory();
    copy = Eigen::Map<const MatrixX>(static_cast<const double*>(x->x), rhs.rows(), rhs.cols());
    cholmod()->free_dense(&x, &self.common);
    return copy;
}

}  // namespace fettle::core::linear

#else

namespace fettle::core::linear {

struct SupernodalCholesky::Implementation {};

SupernodalCholesky::SupernodalCholesky() = default;
SupernodalCholesky::~SupernodalCholesky() = default;
SupernodalCholesky::SupernodalCholesky(SupernodalCholesky&&) noexcept = default;
SupernodalCholesky& SupernodalCholesky::operator=(SupernodalCholesky&&) noexcept = default;

bool SupernodalCholesky::is_available() { return false; }
void SupernodalCholesky::analyse(const BlockHessian&, const FreeDofs&, const std::vector<int>&, double) {}
bool SupernodalCholesky::factorise(const BlockHessian&, const FreeDofs&) { return false; }
MatrixX SupernodalCholesky::solve(const MatrixX& rhs) const {
    FETTLE_ASSERT(false, "built without CHOLMOD");
    return rhs;
}

}  // namespace fettle::core::linear

#endif
