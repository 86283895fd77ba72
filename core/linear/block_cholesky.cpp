// SPDX-License-Identifier: MIT
#include "core/linear/block_cholesky.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/parallel.hpp"

namespace fettle::core::linear {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// In place, the lower triangle; zeros above. @return false if it is not positive definite
bool cholesky(Matrix6& a) {
    for (int j = 0; j < 6; ++j) {
        double pivot = a(j, j);
        for (int k = 0; k < j; ++k) pivot -= a(j, k) * a(j, k);
        if (!(pivot > 0) || !std::isfinite(pivot)) return false;
        pivot = std::sqrt(pivot);
        a(j, j) = pivot;
        const double inverse = 1 / pivot;
        for (int i = j + 1; i < 6; ++i) {
            double sum = a(i, j);
            for (int k = 0; k < j; ++k) sum -= a(i, k) * a(j, k);
            a(i, j) = sum * inverse;
            a(j, i) = 0;
        }
    }
    return true;
}

// b <- b l^-T.
void solve_from_right(const Matrix6& l, Matrix6& b) {
    for (int j = 0; j < 6; ++j) {
        for (int k = 0; k < j; ++k) b.col(j) -= l(j, k) * b.col(k);
        b.col(j) *= 1 / l(j, j);
    }
}

// a -= b c^T.
void subtract_product(Matrix6& a, const Matrix6& b, const Matrix6& c) {
    for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) a.col(j) -= c(j, k) * b.col(k);
}

// Order of elimination of the nodes.
std::vector<int> minimum_degree(const std::vector<std::vector<int>>& neighbours) {
    const int n = count_of(neighbours);
    std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, 1);
        for (const int j : neighbours[at(i)])
            if (j < i) entries.emplace_back(i, j, 1);
    }
    Eigen::SparseMatrix<double> graph(n, n);
    graph.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
    Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), permutation);
    return {permutation.indices().data(), permutation.indices().data() + n};
}

// Free DOFs of a block whose others are prescribed: those are as good as not there.
Matrix6 free_part(const Matrix6& block, const std::array<int, 6>& rows, const std::array<int, 6>& columns) {
    Matrix6 out = block;
    for (int k = 0; k < 6; ++k) {
        if (rows[at(k)] < 0) out.row(k).setZero();
        if (columns[at(k)] < 0) out.col(k).setZero();
    }
    return out;
}

}  // namespace

bool BlockCholesky::analyse(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
    const auto is_same = [](const kinematics::OffDiagonalBlock& b, const std::pair<int, int>& known) {
        return b.a == known.first && b.b == known.second;
    };
    const auto& couplings = hessian.off_diagonal;
    if (analysed_ && std::equal(couplings.begin(), couplings.end(), pattern_.begin(), pattern_.end(), is_same)) return false;
    std::vector<std::pair<int, int>> pattern;
    pattern.reserve(couplings.size());
    for (const auto& b : couplings) pattern.emplace_back(b.a, b.b);
    FETTLE_ASSERT(std::adjacent_find(pattern.begin(), pattern.end(), std::greater_equal<>()) == pattern.end(), "blocks out of order");
    pattern_ = std::move(pattern);
    analysed_ = true;
    std::vector<int> bodies;
    node_of_.assign(dofs.index.size(), -1);
    for (std::size_t body = 0; body < dofs.index.size(); ++body) {
        if (is_none_free(dofs.index[body])) continue;
        node_of_[body] = count_of(bodies);
        bodies.push_back(static_cast<int>(body));
    }
    std::vector<std::vector<int>> neighbours(bodies.size());
    for (const auto& [a, b] : pattern_) {
        if (node_of_[at(a)] < 0 || node_of_[at(b)] < 0) continue;
        neighbours[at(node_of_[at(a)])].push_back(node_of_[at(b)]);
        neighbours[at(node_of_[at(b)])].push_back(node_of_[at(a)]);
    }
    const std::vector<int> order = minimum_degree(neighbours);
    std::vector<int> place(bodies.size());
    body_of_.resize(bodies.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        body_of_[k] = bodies[at(order[k])];
        place[at(order[k])] = static_cast<int>(k);
    }
    for (std::size_t k = 0; k < body_of_.size(); ++k) node_of_[at(body_of_[k])] = static_cast<int>(k);
    std::vector<std::vector<int>> ordered(bodies.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        ordered[k] = std::move(neighbours[at(order[k])]);
        for (int& j : ordered[k]) j = place[at(j)];
    }
    find_columns(ordered);
    return true;
}

// The rows of a column: the matrix's own, and those of the columns whose first row it is.
void BlockCholesky::find_columns(const std::vector<std::vector<int>>& neighbours) {
    const std::size_t n = neighbours.size();
    for (std::vector<std::vector<Entry>>* lists : {&columns_, &rows_}) {
        lists->resize(n);
        for (std::vector<Entry>& list : *lists) list.clear();  // and keep its memory
    }
    std::vector<int> last_child(n, -1), sibling(n, -1);  // of each column's children the last one; before each child another one
    std::vector<int> rows;
    int blocks = 0;
    for (std::size_t j = 0; j < n; ++j) {
        rows.clear();
        for (const int i : neighbours[j])
            if (i > static_cast<int>(j)) rows.push_back(i);
        for (int child = last_child[j]; child >= 0; child = sibling[at(child)])
            for (const Entry& entry : columns_[at(child)])
                if (entry.row > static_cast<int>(j)) rows.push_back(entry.row);
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        for (const int i : rows) {
            rows_[at(i)].push_back({static_cast<int>(j), count_of(columns_[j])});
            columns_[j].push_back({i, blocks++});
        }
        if (!rows.empty()) sibling[j] = std::exchange(last_child[at(rows.front())], static_cast<int>(j));
    }
    block_of_.clear();
    for (const auto& [a, b] : pattern_) {
        const int na = node_of_[at(a)], nb = node_of_[at(b)];
        if (na < 0 || nb < 0) {
            block_of_.push_back(-1);
            continue;
        }
        const std::vector<Entry>& column = columns_[at(std::min(na, nb))];
        const auto entry =
            std::lower_bound(column.begin(), column.end(), std::max(na, nb), [](const Entry& e, int row) { return e.row < row; });
        block_of_.push_back(entry->block);
    }
    std::vector<char> is_coupling(at(blocks), 0);
    for (const int block : block_of_)
        if (block >= 0) is_coupling[at(block)] = 1;
    filled_in_.clear();
    for (std::size_t block = 0; block < is_coupling.size(); ++block)
        if (is_coupling[block] == 0) filled_in_.push_back(static_cast<int>(block));
    find_levels();
}

// A column needs those that have a row in it.
void BlockCholesky::find_levels() {
    constexpr double factor_products = 60, solve_products = 150;  // of blocks, and of blocks with vectors, that a thread takes at a time
    constexpr double operations_a_product = 2 * 6 * 6 * 6;
    levels_.clear();
    operations_ = 0;
    std::vector<std::size_t> level(columns_.size(), 0);
    struct Work {
        double factor = 0, solve = 0;
    };
    std::vector<Work> work;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
        std::size_t products = columns_[j].size() + 1;
        for (const Entry& before : rows_[j]) {
            level[j] = std::max(level[j], level[at(before.row)] + 1);
            products += columns_[at(before.row)].size() - at(before.block);
        }
        if (level[j] >= levels_.size()) {
            levels_.resize(level[j] + 1);
            work.resize(level[j] + 1);
        }
        levels_[level[j]].columns.push_back(static_cast<int>(j));
        work[level[j]].factor += static_cast<double>(products);
        operations_ += operations_a_product * static_cast<double>(products);
        work[level[j]].solve += static_cast<double>(columns_[j].size() + 1);
    }
    for (std::size_t k = 0; k < levels_.size(); ++k) {
        const auto count = static_cast<double>(levels_[k].columns.size());
        levels_[k].factor_grain = std::max(1, static_cast<int>(factor_products * count / work[k].factor));
        levels_[k].solve_grain = std::max(1, static_cast<int>(solve_products * count / work[k].solve));
    }
}

void BlockCholesky::fill(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
    constexpr int blocks_a_piece = 64;
    const auto nodes = count_of(body_of_), couplings = count_of(hessian.off_diagonal);
    diagonal_.resize(body_of_.size());
    blocks_.resize(filled_in_.size() + at(couplings));
    for (const int block : filled_in_) blocks_[at(block)].setZero();
    base::parallel_for(nodes + couplings, blocks_a_piece, [&](int i) {
        if (i < nodes) {
            const std::size_t body = at(body_of_[at(i)]);
            Matrix6& block = diagonal_[at(i)];
            block = free_part(hessian.diagonal[body], dofs.index[body], dofs.index[body]);
            for (int k = 0; k < 6; ++k)
                if (dofs.index[body][at(k)] < 0) block(k, k) = 1;
            return;
        }
        const int k = i - nodes;
        if (block_of_[at(k)] < 0) return;
        const kinematics::OffDiagonalBlock& b = hessian.off_diagonal[at(k)];
        const Matrix6 block = free_part(b.block, dofs.index[at(b.a)], dofs.index[at(b.b)]);
        blocks_[at(block_of_[at(k)])] = node_of_[at(b.a)] > node_of_[at(b.b)] ? block : Matrix6(block.transpose());
    });
}

bool BlockCholesky::eliminate(int column) {
    static thread_local std::vector<int> place;  // [node] where a row stands in the column at hand; of other rows anything
    if (place.size() < columns_.size()) place.resize(columns_.size());
    Matrix6& pivot = diagonal_[at(column)];
    const std::vector<Entry>& below = columns_[at(column)];
    for (const Entry& entry : below) place[at(entry.row)] = entry.block;
    for (const Entry& before : rows_[at(column)]) {
        const std::vector<Entry>& other = columns_[at(before.row)];
        const Matrix6& reach = blocks_[at(other[at(before.block)].block)];
        subtract_product(pivot, reach, reach);
        for (std::size_t k = at(before.block) + 1; k < other.size(); ++k)
            subtract_product(blocks_[at(place[at(other[k].row)])], blocks_[at(other[k].block)], reach);
    }
    if (!cholesky(pivot)) return false;
    for (const Entry& entry : below) solve_from_right(pivot, blocks_[at(entry.block)]);
    return true;
}

bool BlockCholesky::factorise(const kinematics::BlockHessian& hessian, const FreeDofs& dofs) {
    fill(hessian, dofs);
    for (const Level& level : levels_) {
        std::atomic<bool> is_positive = true;
        base::parallel_for(count_of(level.columns), level.factor_grain, [&](int k) {
            if (!eliminate(level.columns[at(k)])) is_positive = false;
        });
        if (!is_positive) return false;
    }
    return true;
}

// In place, `width` right-hand sides side by side, by the nodes: each takes what it needs from those before it, then from those below it,
// in their order.
void BlockCholesky::solve_panel(int width, std::vector<Vector6>& x) const {
    const auto of_node = [&](int k) { return x.data() + at(k) * at(width); };
    for (const Level& level : levels_)
        base::parallel_for(count_of(level.columns), level.solve_grain, [&](int i) {
            const int k = level.columns[at(i)];
            Vector6* const mine = of_node(k);
            for (const Entry& before : rows_[at(k)]) {
                const Matrix6& block = blocks_[at(columns_[at(before.row)][at(before.block)].block)];
                const Vector6* const theirs = of_node(before.row);
                for (int c = 0; c < width; ++c) mine[c] -= block * theirs[c];
            }
            for (int c = 0; c < width; ++c) diagonal_[at(k)].triangularView<Eigen::Lower>().solveInPlace(mine[c]);
        });
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
        base::parallel_for(count_of(level->columns), level->solve_grain, [&](int i) {
            const int k = level->columns[at(i)];
            Vector6* const mine = of_node(k);
            for (const Entry& entry : columns_[at(k)]) {
                const Matrix6& block = blocks_[at(entry.block)];
                const Vector6* const theirs = of_node(entry.row);
                for (int c = 0; c < width; ++c) mine[c] -= block.transpose() * theirs[c];
            }
            for (int c = 0; c < width; ++c) diagonal_[at(k)].transpose().triangularView<Eigen::Upper>().solveInPlace(mine[c]);
        });
}

MatrixX BlockCholesky::solve(const MatrixX& rhs, const FreeDofs& dofs) const {
    constexpr int widest = 8;                    // right-hand sides that share a pass through the factor
    static thread_local std::vector<Vector6> x;  // stays from call to call
    MatrixX out(rhs.rows(), rhs.cols());
    for (int first = 0; first < rhs.cols(); first += widest) {
        const int width = std::min(widest, static_cast<int>(rhs.cols()) - first);
        x.resize(columns_.size() * at(width));
        const auto for_each = [&](const auto& whole, const auto& single) {
            for (std::size_t k = 0; k < columns_.size(); ++k) {
                const std::array<int, 6>& index = dofs.index[at(body_of_[k])];
                for (int c = 0; c < width; ++c) {
                    Vector6& value = x[k * at(width) + at(c)];
                    if (are_all_free(index)) {
                        whole(value, index[0], first + c);
                        continue;
                    }
                    for (int i = 0; i < 6; ++i) single(value[i], index[at(i)], first + c);
                }
            }
        };
        for_each([&](Vector6& value, int row, int column) { value = rhs.col(column).segment<6>(row); },
                 [&](double& value, int row, int column) { value = row >= 0 ? rhs(row, column) : 0; });
        solve_panel(width, x);
        for_each([&](const Vector6& value, int row, int column) { out.col(column).segment<6>(row) = value; },
                 [&](double value, int row, int column) {
                     if (row >= 0) out(row, column) = value;
                 });
    }
    return out;
}

}  // namespace fettle::core::linear
