// SPDX-License-Identifier: MIT
#include "core/linear/quasi_definite_factor.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/contract.hpp"

namespace fettle::core::linear {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // right-hand sides, side by side

constexpr double delta_share = 1e-13;  // of a row's pivot by itself

// What decides which entries the matrix has.
struct Pattern {
    std::vector<std::pair<int, int>> blocks;  // of the Hessian
    std::vector<int> row_first, row_bodies;
    bool operator==(const Pattern&) const = default;
};

Pattern pattern_of(const kinematics::BlockHessian& hessian, const RowJacobian& rows) {
    Pattern out;
    for (const auto& b : hessian.off_diagonal) out.blocks.emplace_back(b.a, b.b);
    out.row_first = rows.first;
    for (const RowGradient& e : rows.entries) out.row_bodies.push_back(e.body);
    return out;
}

// Bodies in the order of least fill; edges are blocks of the Hessian and pairs of bodies of one row.
std::vector<int> body_order(int bodies, const Pattern& pattern) {
    std::vector<Eigen::Triplet<double>> edges;
    const auto add = [&](int a, int b) {
        edges.emplace_back(a, b, 1.0);
        edges.emplace_back(b, a, 1.0);
    };
    for (int i = 0; i < bodies; ++i) edges.emplace_back(i, i, 1.0);
    for (const auto& [a, b] : pattern.blocks) add(a, b);
    for (std::size_t row = 0; row + 1 < pattern.row_first.size(); ++row)
        for (int i = pattern.row_first[row]; i < pattern.row_first[row + 1]; ++i)
            for (int j = i + 1; j < pattern.row_first[row + 1]; ++j) add(pattern.row_bodies[i], pattern.row_bodies[j]);
    Sparse graph(bodies, bodies);
    graph.setFromTriplets(edges.begin(), edges.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> p;
    Eigen::AMDOrdering<int>()(graph, p);
    return {p.indices().data(), p.indices().data() + p.size()};
}

}  // namespace

struct QuasiDefiniteFactor::Implementation {
    std::vector<std::array<int, 6>> index;
    int count = 0;  // free degrees of freedom
    int rows = 0;
    Pattern pattern;
    bool analysed = false, usable = false;
    Sparse matrix;                      // upper triangle, permuted
    std::vector<std::size_t> position;  // of each visited entry in the matrix
    std::vector<int> place;             // of each unknown: its column
    VectorX delta;                      // per row
    VectorX own_pivot;                  // per row: sum_k C_k^2 / H_kk
    using Factor = Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>>;
    Factor factor;
    bool is_augmented = false;  // then the factor in use is that of H + C^T weights C, which is definite where H is so on the rows only
    Factor augmented_factor;
    Sparse gradients;  // C, its columns in the matrix's order
    VectorX weights;   // per row

    // Calls entry(unknown, unknown, value) once for each entry of one triangle, in a fixed order.
    template <class Entry>
    void for_each_entry(const kinematics::BlockHessian& hessian, const RowJacobian& jacobian, const Entry& entry) const {
        for (std::size_t body = 0; body < index.size(); ++body)
            for (int j = 0; j < 6; ++j)
                for (int i = j; i < 6; ++i)
                    if (index[body][i] >= 0 && index[body][j] >= 0) entry(index[body][i], index[body][j], hessian.diagonal[body](i, j));
        for (const kinematics::OffDiagonalBlock& b : hessian.off_diagonal)
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j)
                    if (index[b.a][i] >= 0 && index[b.b][j] >= 0) entry(index[b.a][i], index[b.b][j], b.block(i, j));
        for (int row = 0; row < rows; ++row) {
            for (int k = jacobian.first[row]; k < jacobian.first[row + 1]; ++k) {
                const RowGradient& e = jacobian.entries[k];
                for (int i = 0; i < 6; ++i)
                    if (index[e.body][i] >= 0) entry(count + row, index[e.body][i], e.gradient[i]);
            }
            entry(count + row, count + row, -delta[row]);
        }
    }

    void order(const Pattern& wanted) {
        std::vector<int> rank(index.size(), -1);
        const std::vector<int> bodies = body_order(count_of(index), wanted);
        for (std::size_t k = 0; k < bodies.size(); ++k) rank[bodies[k]] = static_cast<int>(k);
        // Rows after the last of their bodies of which anything is free; those of none are first.
        std::vector<std::vector<int>> after(index.size());
        place.assign(count + rows, -1);
        int next = 0;
        for (int row = 0; row < rows; ++row) {
            int last = -1;
            for (int k = wanted.row_first[row]; k < wanted.row_first[row + 1]; ++k) last = std::max(last, rank[wanted.row_bodies[k]]);
            if (last < 0)
                place[count + row] = next++;
            else
                after[last].push_back(row);
        }
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            for (const int unknown : index[bodies[k]])
                if (unknown >= 0) place[unknown] = next++;
            for (const int row : after[k]) place[count + row] = next++;
        }
    }

    void analyse(const kinematics::BlockHessian& hessian, const RowJacobian& jacobian) {
        Pattern wanted = pattern_of(hessian, jacobian);
        if (analysed && wanted == pattern) return;
        order(wanted);
        pattern = std::move(wanted);
        std::vector<Eigen::Triplet<double>> entries;
        for_each_entry(hessian, jacobian, [&](int i, int j, double) {
            const int a = place[i], b = place[j];
            entries.emplace_back(std::min(a, b), std::max(a, b), 1.0);
        });
        matrix.resize(count + rows, count + rows);
        matrix.setFromTriplets(entries.begin(), entries.end());
        matrix.makeCompressed();
        position.clear();
        for (const auto& e : entries) {
            const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[e.col()];
            const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[e.col() + 1];
            position.push_back(static_cast<std::size_t>(std::lower_bound(begin, end, e.row()) - matrix.innerIndexPtr()));
        }
        factor.analyzePattern(matrix);
        analysed = true;
    }

    void measure_rows(const kinematics::BlockHessian& hessian, const RowJacobian& jacobian) {
        own_pivot = VectorX::Zero(rows);
        for (int row = 0; row < rows; ++row)
            for (int k = jacobian.first[row]; k < jacobian.first[row + 1]; ++k) {
                const RowGradient& e = jacobian.entries[k];
                for (int i = 0; i < 6; ++i) {
                    const double h = std::abs(hessian.diagonal[e.body](i, i));
                    if (index[e.body][i] >= 0 && h > 0) own_pivot[row] += e.gradient[i] * e.gradient[i] / h;
                }
            }
        const double largest = rows > 0 ? own_pivot.maxCoeff() : 0;
        delta = (delta_share * own_pivot).cwiseMax(delta_share * delta_share * (largest > 0 ? largest : 1));
    }

    // Without pivoting, an H that is indefinite across the rows would spoil the factor.
    void augment(const RowJacobian& jacobian) {
        constexpr double share = 10;  // of what a row weighs against the diagonal of H
        std::vector<Eigen::Triplet<double>> entries;
        for (int row = 0; row < rows; ++row)
            for (int k = jacobian.first[row]; k < jacobian.first[row + 1]; ++k)
                for (int i = 0; i < 6; ++i) {
                    const int unknown = index[jacobian.entries[k].body][i];
                    if (unknown >= 0) entries.emplace_back(row, place[unknown], jacobian.entries[k].gradient[i]);
                }
        gradients.resize(rows, count + rows);
        gradients.setFromTriplets(entries.begin(), entries.end());
        weights = share * own_pivot.cwiseMax(std::numeric_limits<double>::min()).cwiseInverse();
        const Sparse squares = gradients.transpose() * weights.asDiagonal() * gradients;
        const Sparse augmented = matrix + Sparse(squares.triangularView<Eigen::Upper>());
        augmented_factor.compute(augmented);
        is_augmented = true;
    }

    // Right-hand sides in the matrix's order become solutions: the same ones with either factor.
    void through_factor(Columns& x) const {
        if (is_augmented) {
            Columns c(rows, x.cols());
            for (int i = 0; i < rows; ++i) c.row(i) = weights[i] * x.row(place[count + i]);
            x += gradients.transpose() * c;
        }
        const Factor& f = is_augmented ? augmented_factor : factor;
        if (x.cols() == 1)
            solve_in_place<1>(f, x);
        else
            solve_in_place<Eigen::Dynamic>(f, x);
    }

    // All right-hand sides in one pass through L, and one back. Width: 1, for the compiler to know, or Eigen::Dynamic.
    template <int Width>
    static void solve_in_place(const Factor& f, Columns& x) {
        const Sparse& l = f.matrixL().nestedExpression();  // its diagonal is 1
        const int *const first = l.outerIndexPtr(), *const rows = l.innerIndexPtr();
        const double* const entries = l.valuePtr();
        const VectorX pivots = f.vectorD();
        const Eigen::Index n = x.rows(), width = Width == 1 ? 1 : x.cols();
        using Row = Eigen::Array<double, 1, Width, Eigen::RowMajor>;
        const auto row = [&, values = x.data()](Eigen::Index j) { return Eigen::Map<Row>(values + j * width, width); };
        Row own(width);
        for (Eigen::Index j = 0; j < n; ++j) {
            own = row(j);
            for (int k = first[j]; k < first[j + 1]; ++k) row(rows[k]) -= own * entries[k];
        }
        for (Eigen::Index j = 0; j < n; ++j) row(j) *= 1 / pivots[j];
        for (Eigen::Index j = n; j-- > 0;) {
            own = row(j);
            for (int k = first[j]; k < first[j + 1]; ++k) own -= entries[k] * row(rows[k]);
            row(j) = own;
        }
    }

    bool matrix_is_finite() const { return Eigen::Map<const VectorX>(matrix.valuePtr(), matrix.nonZeros()).allFinite(); }

    static bool is_sound(const Factor& f) { return f.info() == Eigen::Success && f.vectorD().allFinite(); }

    // Every degree of freedom's pivot positive, every row's negative: H is definite as it is.
    bool is_quasi_definite() const {
        const VectorX pivots = factor.vectorD();
        for (int i = 0; i < count; ++i)
            if (!(pivots[place[i]] > 0)) return false;
        for (int i = 0; i < rows; ++i)
            if (!(pivots[place[count + i]] < 0)) return false;
        return true;
    }
};

QuasiDefiniteFactor::QuasiDefiniteFactor() : implementation_(std::make_unique<Implementation>()) {}
QuasiDefiniteFactor::~QuasiDefiniteFactor() = default;
QuasiDefiniteFactor::QuasiDefiniteFactor(QuasiDefiniteFactor&&) noexcept = default;
QuasiDefiniteFactor& QuasiDefiniteFactor::operator=(QuasiDefiniteFactor&&) noexcept = default;

bool QuasiDefiniteFactor::factorise(const BlockHessian& hessian, const RowJacobian& rows, const FreeDofs& dofs) {
    Implementation& self = *implementation_;
    self.index = dofs.index;
    self.count = dofs.count;
    self.rows = rows.count();
    self.measure_rows(hessian, rows);
    self.analyse(hessian, rows);
    double* values = self.matrix.valuePtr();
    std::fill(values, values + self.matrix.nonZeros(), 0.0);
    std::size_t k = 0;
    self.for_each_entry(hessian, rows, [&](int, int, double value) { values[self.position[k++]] += value; });
    self.factor.factorize(self.matrix);
    self.is_augmented = false;
    self.usable = Implementation::is_sound(self.factor);
    if (self.usable && self.is_quasi_definite()) return true;
    if (!self.matrix_is_finite()) return self.usable = false;
    self.augment(rows);
    self.usable = Implementation::is_sound(self.augmented_factor);
    // As many positive pivots as degrees of freedom: H is definite on the rows (Sylvester).
    return self.usable && (self.augmented_factor.vectorD().array() > 0).count() == self.count;
}

bool QuasiDefiniteFactor::is_usable() const { return implementation_->usable; }

MatrixX QuasiDefiniteFactor::solve(const MatrixX& rhs) const {
    const Implementation& self = *implementation_;
    FETTLE_ASSERT(self.usable, "solve without a factorisation");
    Columns x(rhs.rows(), rhs.cols());
    for (Eigen::Index i = 0; i < rhs.rows(); ++i) x.row(self.place[i]) = rhs.row(i);
    self.through_factor(x);
    MatrixX out(rhs.rows(), rhs.cols());
    for (Eigen::Index i = 0; i < rhs.rows(); ++i) out.row(i) = x.row(self.place[i]);
    return out;
}

}  // namespace fettle::core::linear
