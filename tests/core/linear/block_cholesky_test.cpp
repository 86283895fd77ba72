// SPDX-License-Identifier: MIT
// The factor by blocks against a dense one, on random graphs of bodies with prescribed coordinates.
#include "core/linear/block_cholesky.hpp"
#include "core/linear/factorisations.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/parallel.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::linear::block_cholesky_test {

namespace {

FreeDofs some_free(int bodies, std::mt19937& random) {
    FreeDofs out;
    for (int i = 0; i < bodies; ++i) {
        const bool held = random() % 7 == 0;
        const int prescribed = random() % 3 == 0 ? static_cast<int>(random() % 6) : -1;
        out.add_body([&](int k) { return !held && k != prescribed; });
    }
    return out;
}

// J J^T over random couplings: positive semi-definite, with `shift` definite.
kinematics::BlockHessian coupled(int bodies, double density, double shift, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> chance(0, 1);
    kinematics::BlockHessian h{std::vector<Matrix6>(bodies, shift * Matrix6::Identity()), {}};
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b) {
            if (chance(random) > density) continue;
            const Matrix6 p = Matrix6::NullaryExpr([&] { return normal(random); }),
                          q = Matrix6::NullaryExpr([&] { return normal(random); });
            h.diagonal[a] += p * p.transpose();
            h.diagonal[b] += q * q.transpose();
            h.off_diagonal.push_back({a, b, p * q.transpose()});
        }
    return h;
}

MatrixX dense(const kinematics::BlockHessian& h, const FreeDofs& dofs) {
    MatrixX out(dofs.count, dofs.count);
    for (int k = 0; k < dofs.count; ++k) {
        std::vector<Vector6> unit(h.diagonal.size(), Vector6::Zero());
        scatter(dofs, VectorX::Unit(dofs.count, k), unit);
        out.col(k) = gather(dofs, multiply(h, unit));
    }
    return out;
}

}  // namespace

TEST_CASE("the factor by blocks solves as a dense one does", "[block_cholesky]") {
    std::mt19937 random(11);
    for (int k = 0; k < 60; ++k) {
        const int bodies = 1 + static_cast<int>(random() % 30);
        const FreeDofs dofs = some_free(bodies, random);
        if (dofs.count == 0) continue;
        const auto h = coupled(bodies, k % 3 == 0 ? 1.0 : 0.15, 0.1, random);
        BlockCholesky factor;
        factor.analyse(h, dofs);
        REQUIRE(factor.factorise(h, dofs));
        const MatrixX rhs = MatrixX::Random(dofs.count, 3), matrix = dense(h, dofs);
        const MatrixX expected = matrix.llt().solve(rhs);
        CHECK((factor.solve(rhs, dofs) - expected).norm() <= 1e-11 * expected.norm() * matrix.norm());
        CHECK((matrix * factor.solve(rhs, dofs) - rhs).norm() <= 1e-10 * rhs.norm());
    }
}

TEST_CASE("a right-hand side has the same solution whatever stands beside it", "[block_cholesky]") {
    std::mt19937 random(14);
    const FreeDofs dofs = some_free(40, random);
    const auto h = coupled(40, 0.15, 0.1, random);
    BlockCholesky factor;
    factor.analyse(h, dofs);
    REQUIRE(factor.factorise(h, dofs));
    const MatrixX rhs = MatrixX::Random(dofs.count, 21), together = factor.solve(rhs, dofs);
    for (Eigen::Index c = 0; c < rhs.cols(); ++c) CHECK(factor.solve(rhs.col(c), dofs) == together.col(c));
}

TEST_CASE("a factor of many bodies solves, with the same bits for any number of threads", "[block_cholesky]") {
    std::mt19937 random(13);
    constexpr int bodies = 700;
    const FreeDofs dofs = some_free(bodies, random);
    const auto h = coupled(bodies, 1.2 / bodies, 0.1, random);
    const VectorX rhs = VectorX::Random(dofs.count);
    std::vector<MatrixX> solutions;
    for (const int threads : {1, 2, 4}) {
        const base::ThreadLimit limit(threads);
        BlockCholesky factor;
        factor.analyse(h, dofs);
        REQUIRE(factor.factorise(h, dofs));
        solutions.push_back(factor.solve(rhs, dofs));
    }
    std::vector<Vector6> x(bodies, Vector6::Zero());
    scatter(dofs, solutions[0], x);
    CHECK((gather(dofs, multiply(h, x)) - rhs).norm() <= 1e-10 * rhs.norm());
    CHECK(solutions[1] == solutions[0]);
    CHECK(solutions[2] == solutions[0]);
}

TEST_CASE("what is not positive definite, or no number, has no factor", "[block_cholesky]") {
    std::mt19937 random(12);
    int refused = 0;
    for (int k = 0; k < 200; ++k) {
        const int bodies = 2 + static_cast<int>(random() % 12);
        const FreeDofs dofs = some_free(bodies, random);
        if (dofs.count == 0) continue;
        auto h = coupled(bodies, 0.4, 1, random);
        for (Matrix6& block : h.diagonal) block -= (0.5 + 0.02 * k) * Matrix6::Identity();
        const double least = symmetric_eigenvalues<Eigen::Dynamic>(dense(h, dofs))[0];
        if (std::abs(least) < 1e-9) continue;
        BlockCholesky factor;
        factor.analyse(h, dofs);
        CHECK(factor.factorise(h, dofs) == (least > 0));
        refused += least < 0;
    }
    CHECK(refused > 20);
    const FreeDofs dofs = some_free(3, random);
    auto h = coupled(3, 1, 1, random);
    for (Matrix6& block : h.diagonal) block(2, 2) = std::numeric_limits<double>::quiet_NaN();
    BlockCholesky factor;
    factor.analyse(h, dofs);
    CHECK((dofs.count == 0 || !factor.factorise(h, dofs)));
}

TEST_CASE("other couplings are analysed anew", "[block_cholesky]") {
    std::mt19937 random(13);
    FreeDofs dofs;
    for (int i = 0; i < 9; ++i) dofs.add_body([](int) { return true; });
    BlockCholesky factor;
    for (const double density : {0.2, 0.2, 0.8, 0.0, 0.5}) {
        const auto h = coupled(9, density, 1, random);
        factor.analyse(h, dofs);
        REQUIRE(factor.factorise(h, dofs));
        const MatrixX rhs = MatrixX::Random(dofs.count, 1);
        CHECK((dense(h, dofs) * factor.solve(rhs, dofs) - rhs).norm() <= 1e-11 * rhs.norm());
    }
}

}  // namespace fettle::core::linear::block_cholesky_test
