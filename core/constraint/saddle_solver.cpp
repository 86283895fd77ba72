// SPDX-License-Identifier: MIT
#include "fettle/core/constraint/saddle_solver.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fettle/core/base/contract.hpp"

namespace fettle::core::constraint {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double delta_share = 1e-13;  // of a row's pivot by itself
constexpr int most_refinements = 4;
constexpr double refined_enough = 1e-15;

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
            for (int j = i + 1; j < pattern.row_first[row + 1]; ++j)
                add(pattern.row_bodies[static_cast<std::size_t>(i)], pattern.row_bodies[static_cast<std::size_t>(j)]);
    Sparse graph(bodies, bodies);
    graph.setFromTriplets(edges.begin(), edges.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> p;
    Eigen::AMDOrdering<int>()(graph, p);
    return {p.indices().data(), p.indices().data() + p.size()};
}

}  // namespace

struct SaddleSolver::Implementation {
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
    VectorX scale;                      // a residual r counts as scale r: 1 / sqrt(diagonal)
    Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> factor;

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
        const std::vector<int> bodies = body_order(static_cast<int>(index.size()), wanted);
        for (std::size_t k = 0; k < bodies.size(); ++k) rank[static_cast<std::size_t>(bodies[k])] = static_cast<int>(k);
        // Rows after the last of their bodies of which anything is free; those of none are first.
        std::vector<std::vector<int>> after(index.size());
        place.assign(static_cast<std::size_t>(count + rows), -1);
        int next = 0;
        for (int row = 0; row < rows; ++row) {
            int last = -1;
            for (int k = wanted.row_first[row]; k < wanted.row_first[row + 1]; ++k)
                last = std::max(last, rank[static_cast<std::size_t>(wanted.row_bodies[k])]);
            if (last < 0)
                place[static_cast<std::size_t>(count + row)] = next++;
            else
                after[static_cast<std::size_t>(last)].push_back(row);
        }
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            for (const int unknown : index[static_cast<std::size_t>(bodies[k])])
                if (unknown >= 0) place[static_cast<std::size_t>(unknown)] = next++;
            for (const int row : after[k]) place[static_cast<std::size_t>(count + row)] = next++;
        }
    }

    void analyse(const kinematics::BlockHessian& hessian, const RowJacobian& jacobian) {
        Pattern wanted = pattern_of(hessian, jacobian);
        if (analysed && wanted == pattern) return;
        order(wanted);
        pattern = std::move(wanted);
        std::vector<Eigen::Triplet<double>> entries;
        for_each_entry(hessian, jacobian, [&](int i, int j, double) {
            const int a = place[static_cast<std::size_t>(i)], b = place[static_cast<std::size_t>(j)];
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

    void measure_unknowns(const kinematics::BlockHessian& hessian) {
        const auto inverse_root = [](double x) { return x != 0 ? 1 / std::sqrt(std::abs(x)) : 1; };
        scale.resize(count + rows);
        for (std::size_t body = 0; body < index.size(); ++body)
            for (int i = 0; i < 6; ++i)
                if (index[body][i] >= 0) scale[place[index[body][i]]] = inverse_root(hessian.diagonal[body](i, i));
        for (int i = 0; i < rows; ++i) scale[place[count + i]] = inverse_root(own_pivot[i]);
    }

    VectorX permuted(const VectorX& r, const VectorX& c) const {
        VectorX out(count + rows);
        for (int i = 0; i < count; ++i) out[place[i]] = r[i];
        for (int i = 0; i < rows; ++i) out[place[count + i]] = c[i];
        return out;
    }

    Solution split(const VectorX& x) const {
        Solution out{VectorX(count), VectorX(rows), 0};
        for (int i = 0; i < count; ++i) out.y[i] = x[place[i]];
        for (int i = 0; i < rows; ++i) out.multipliers[i] = x[place[count + i]];
        return out;
    }

    // Without delta.
    VectorX times_matrix(const VectorX& x) const {
        VectorX out = matrix.selfadjointView<Eigen::Upper>() * x;
        for (int i = 0; i < rows; ++i) out[place[count + i]] += delta[i] * x[place[count + i]];
        return out;
    }
};

SaddleSolver::SaddleSolver(std::vector<std::array<int, 6>> index, int count) : implementation_(std::make_unique<Implementation>()) {
    implementation_->index = std::move(index);
    implementation_->count = count;
}
SaddleSolver::~SaddleSolver() = default;
SaddleSolver::SaddleSolver(SaddleSolver&&) noexcept = default;
SaddleSolver& SaddleSolver::operator=(SaddleSolver&&) noexcept = default;

bool SaddleSolver::factorise(const kinematics::BlockHessian& hessian, const RowJacobian& rows) {
    Implementation& self = *implementation_;
    self.rows = rows.count();
    self.measure_rows(hessian, rows);
    self.analyse(hessian, rows);
    double* values = self.matrix.valuePtr();
    std::fill(values, values + self.matrix.nonZeros(), 0.0);
    std::size_t k = 0;
    self.for_each_entry(hessian, rows, [&](int, int, double value) { values[self.position[k++]] += value; });
    self.measure_unknowns(hessian);
    self.factor.factorize(self.matrix);
    self.usable = self.factor.info() == Eigen::Success && self.factor.vectorD().allFinite();
    if (!self.usable) return false;
    const VectorX pivots = self.factor.vectorD();
    for (int i = 0; i < self.count; ++i)
        if (!(pivots[self.place[i]] > 0)) return false;
    for (int i = 0; i < self.rows; ++i)
        if (!(pivots[self.place[self.count + i]] < 0)) return false;
    return true;
}

bool SaddleSolver::is_usable() const { return implementation_->usable; }

SaddleSolver::Solution SaddleSolver::solve_roughly(const VectorX& r, const VectorX& c) const {
    const Implementation& self = *implementation_;
    FETTLE_ASSERT(self.usable, "solve without a factorisation");
    return self.split(self.factor.solve(self.permuted(r, c)));
}

SaddleSolver::Solution SaddleSolver::solve(const VectorX& r, const VectorX& c) const {
    const Implementation& self = *implementation_;
    FETTLE_ASSERT(self.usable, "solve without a factorisation");
    const VectorX rhs = self.permuted(r, c);
    const double size = rhs.cwiseProduct(self.scale).norm();
    VectorX x = self.factor.solve(rhs), best = x;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
        const VectorX residual = rhs - self.times_matrix(x);
        const double error = size > 0 ? residual.cwiseProduct(self.scale).norm() / size : 0;
        if (!(error < least)) break;
        const bool gaining = error < 0.5 * least;
        least = error;
        best = x;
        if (k == most_refinements || error <= refined_enough || !gaining) break;
        x += self.factor.solve(residual);
    }
    Solution out = self.split(best);
    out.error = least;
    return out;
}

VectorX SaddleSolver::relative_pivots() const {
    const Implementation& self = *implementation_;
    const VectorX pivots = self.factor.vectorD();
    VectorX out(self.rows);
    for (int i = 0; i < self.rows; ++i)
        out[i] = self.own_pivot[i] > 0 ? std::abs(pivots[self.place[self.count + i]]) / self.own_pivot[i] : 0;
    return out;
}

}  // namespace fettle::core::constraint
