// SPDX-License-Identifier: MIT
// The saddle-point system against a dense solution, definiteness on the rows, dependent rows.
#include "core/linear/quasi_definite_factor.hpp"
#include "core/linear/factorisations.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "core/constraint/dependent_rows.hpp"
#include "core/linear/linear_system.hpp"

namespace fettle::core::linear::quasi_definite_factor_test {

namespace {

struct System {
    kinematics::BlockHessian hessian;
    RowJacobian rows;
    FreeDofs dofs;
    MatrixX dense_h, dense_c;
};

// A ring of bodies, each joined to the next by `rows_a_joint` random rows; some coordinates are not solved for.
System ring(int bodies, int rows_a_joint, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto noise = [&](auto& m) {
        for (Eigen::Index k = 0; k < m.size(); ++k) m.reshaped()[k] = unit(random);
    };
    System s;
    for (int i = 0; i < bodies; ++i) {
        Matrix6 a;
        noise(a);
        s.hessian.diagonal.push_back(a * a.transpose() + 8 * Matrix6::Identity());
        s.dofs.add_body([&](int k) { return i != 1 || k >= 2; });
    }
    for (int i = 0; i + 1 < bodies; ++i) {
        s.hessian.off_diagonal.push_back({i, i + 1, Matrix6::Zero()});
        noise(s.hessian.off_diagonal.back().block);
    }
    for (int i = 0; i < bodies; ++i)
        for (int k = 0; k < rows_a_joint; ++k) {
            s.rows.first.push_back(count_of(s.rows.entries));
            for (const int b : {std::min(i, (i + 1) % bodies), std::max(i, (i + 1) % bodies)}) {
                s.rows.entries.push_back({b, Vector6::Zero()});
                noise(s.rows.entries.back().gradient);
            }
        }
    s.rows.first.push_back(count_of(s.rows.entries));
    s.dense_h = MatrixX::Zero(s.dofs.count, s.dofs.count);
    s.dense_c = MatrixX::Zero(s.rows.count(), s.dofs.count);
    const auto place = [&](int a, int b, const Matrix6& block) {
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                if (s.dofs.index[a][i] >= 0 && s.dofs.index[b][j] >= 0) s.dense_h(s.dofs.index[a][i], s.dofs.index[b][j]) += block(i, j);
    };
    for (int i = 0; i < bodies; ++i) place(i, i, s.hessian.diagonal[i]);
    for (const auto& b : s.hessian.off_diagonal) {
        place(b.a, b.b, b.block);
        place(b.b, b.a, b.block.transpose());
    }
    for (int row = 0; row < s.rows.count(); ++row)
        for (int k = s.rows.first[row]; k < s.rows.first[row + 1]; ++k)
            for (int i = 0; i < 6; ++i)
                if (s.dofs.index[s.rows.entries[k].body][i] >= 0)
                    s.dense_c(row, s.dofs.index[s.rows.entries[k].body][i]) += s.rows.entries[k].gradient[i];
    return s;
}

VectorX dense_solution(const System& s, const VectorX& r, const VectorX& c) {
    const Eigen::Index n = s.dofs.count, m = s.rows.count();
    MatrixX k = MatrixX::Zero(n + m, n + m);
    k.topLeftCorner(n, n) = s.dense_h;
    k.topRightCorner(n, m) = s.dense_c.transpose();
    k.bottomLeftCorner(m, n) = s.dense_c;
    VectorX b(n + m);
    b << r, c;
    return k.fullPivLu().solve(b);
}

double difference(const LinearSystem::Solution& x, const VectorX& y) {
    VectorX all(y.size());
    all << x.y, x.multipliers;
    return (all - y).norm() / y.norm();
}

}  // namespace

TEST_CASE("the saddle system's solution is the dense one, whatever changes from one matrix to the next", "[linear_system]") {
    std::mt19937_64 random(3);
    for (const int bodies : {2, 3, 7, 20}) {
        System s = ring(bodies, 3, random);
        LinearSystem solver(s.dofs);
        for (int trial = 0; trial < 3; ++trial) {
            const VectorX r = VectorX::Random(s.dofs.count), c = VectorX::Random(s.rows.count());
            CHECK(solver.factorise(s.hessian, s.rows));
            const LinearSystem::Solution x = solver.solve_refined(s.hessian, s.rows, r, c);
            const LinearSystem::Solution left = solver.residual(s.hessian, s.rows, r, c, x);
            CHECK(left.y.norm() + left.multipliers.norm() < 1e-13 * (r.norm() + c.norm() + x.y.norm() + x.multipliers.norm()));
            CHECK(difference(x, dense_solution(s, r, c)) < 1e-12);
            System other = ring(bodies, trial == 1 ? 2 : 3, random);
            s = other;
        }
    }
}

TEST_CASE("what counts is whether H is definite on the rows", "[linear_system]") {
    std::mt19937_64 random(4);
    System s = ring(5, 4, random);
    // Negative across the rows, so that H itself is indefinite by far; on them nothing changes.
    const MatrixX bent = s.dense_h - 50 * s.dense_c.transpose() * s.dense_c;
    REQUIRE(symmetric_eigenvalues<Eigen::Dynamic>(bent).minCoeff() < -10);
    kinematics::BlockHessian hessian = s.hessian;
    const auto subtract = [&](double weight) {
        std::vector<kinematics::OffDiagonalBlock> blocks;
        for (int row = 0; row < s.rows.count(); ++row)
            for (int k = s.rows.first[row]; k < s.rows.first[row + 1]; ++k)
                for (int l = s.rows.first[row]; l < s.rows.first[row + 1]; ++l) {
                    const RowGradient &a = s.rows.entries[k], &b = s.rows.entries[l];
                    const Matrix6 square = -weight * a.gradient * b.gradient.transpose();
                    if (a.body == b.body)
                        hessian.diagonal[a.body] += square;
                    else if (a.body < b.body)
                        blocks.push_back({a.body, b.body, square});
                }
        add_blocks(blocks, hessian);
    };
    subtract(50);
    LinearSystem solver(s.dofs);
    CHECK(solver.factorise(hessian, s.rows));
    const VectorX r = VectorX::Random(s.dofs.count), c = VectorX::Random(s.rows.count());
    System bent_system = s;
    bent_system.dense_h = bent;
    CHECK(difference(solver.solve_refined(hessian, s.rows, r, c), dense_solution(bent_system, r, c)) < 1e-10);
    // Along the rows: there it counts.
    const MatrixX kernel = s.dense_c.fullPivLu().kernel();
    REQUIRE(kernel.cols() > 0);
    kinematics::BlockHessian down = s.hessian;
    for (Matrix6& block : down.diagonal) block -= 100 * Matrix6::Identity();
    CHECK(!solver.factorise(down, s.rows));
}

TEST_CASE("rows that are sums of others are found, with what they are sums of", "[linear_system]") {
    std::mt19937_64 random(5);
    const System s = ring(6, 2, random);
    std::vector<Matrix6> masses = s.hessian.diagonal;
    CHECK(constraint::dependent_rows(masses, s.dofs, s.rows).empty());
    // One more row: the third plus half of the fourth.
    RowJacobian more = s.rows;
    for (int k = s.rows.first[2]; k < s.rows.first[3]; ++k) {
        RowGradient sum = s.rows.entries[k];
        sum.gradient += 0.5 * s.rows.entries[k - s.rows.first[2] + s.rows.first[3]].gradient;
        more.entries.push_back(sum);
    }
    more.first.push_back(count_of(more.entries));
    const std::vector<constraint::DependentRow> found = constraint::dependent_rows(masses, s.dofs, more);
    REQUIRE(found.size() == 1);
    std::vector<int> all = found[0].on;
    all.push_back(found[0].row);
    std::sort(all.begin(), all.end());
    CHECK(all == std::vector<int>{2, 3, 12});
    CHECK(constraint::without(more, found).count() == 12);
}

TEST_CASE("rows of bodies that cannot move depend on nothing", "[constraint]") {
    std::mt19937_64 random(5);
    const System s = ring(3, 2, random);
    FreeDofs none;
    for (int body = 0; body < 3; ++body) none.add_body([](int) { return false; });
    const std::vector<constraint::DependentRow> found = constraint::dependent_rows(s.hessian.diagonal, none, s.rows);
    REQUIRE(count_of(found) == s.rows.count());
    for (const constraint::DependentRow& row : found) CHECK(row.on.empty());
    CHECK(constraint::without(s.rows, found).count() == 0);
}

}  // namespace fettle::core::linear::quasi_definite_factor_test
