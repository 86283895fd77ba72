// SPDX-License-Identifier: MIT
#include "core/linear/linear_system.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <random>

namespace fettle::core::linear::linear_system_test {

namespace {

FreeDofs chain_of_bodies(int n) {
    FreeDofs out;
    for (int i = 0; i < n; ++i) out.add_body([&](int k) { return !(i % 5 == 2 && k == i % 6); });
    return out;
}

kinematics::BlockHessian random_hessian(int n, double shift, std::mt19937& random) {
    std::normal_distribution<double> normal;
    kinematics::BlockHessian h;
    for (int i = 0; i < n; ++i) {
        const Matrix6 r = Matrix6::NullaryExpr([&] { return normal(random); });
        h.diagonal.push_back(r + r.transpose() + shift * Matrix6::Identity());
        if (i > 0) h.off_diagonal.push_back({i - 1, i, Matrix6::NullaryExpr([&] { return normal(random); })});
        if (i > 3) h.off_diagonal.push_back({i - 4, i, Matrix6::NullaryExpr([&] { return normal(random); })});
    }
    std::sort(h.off_diagonal.begin(), h.off_diagonal.end(),
              [](const auto& x, const auto& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
    return h;
}

// |H x - b| over the free DOFs, with the prescribed entries of x zero.
double residual(const kinematics::BlockHessian& h, const FreeDofs& dofs, const VectorX& x, const VectorX& b) {
    std::vector<Vector6> full(h.diagonal.size(), Vector6::Zero());
    scatter(dofs, x, full);
    return (gather(dofs, multiply(h, full)) - b).norm();
}

}  // namespace

TEST_CASE("dense and sparse factorisations solve the free part", "[linear_system]") {
    std::mt19937 random(3);
    for (int bodies : {1, 6, 40}) {  // 6 to 234 free DOFs: both sides of the switch
        const FreeDofs dofs = chain_of_bodies(bodies);
        LinearSystem solver(dofs);
        for (int repeat = 0; repeat < 3; ++repeat) {  // the symbolic factor is reused
            const auto h = random_hessian(bodies, 60, random);
            REQUIRE(solver.factorise(h));
            const VectorX b = VectorX::LinSpaced(dofs.count, -1, 2);
            CHECK(residual(h, dofs, solver.solve(b).y, b) < 1e-12 * b.norm());
        }
    }
}

TEST_CASE("an indefinite matrix is refused by Cholesky and solved by the other factorisation", "[linear_system]") {
    std::mt19937 random(4);
    for (int bodies : {3, 40}) {
        const FreeDofs dofs = chain_of_bodies(bodies);
        LinearSystem solver(dofs);
        const auto h = random_hessian(bodies, 0, random);
        CHECK_FALSE(solver.factorise(h));
        REQUIRE(solver.factorise_any(h));
        const VectorX b = VectorX::LinSpaced(dofs.count, -1, 2);
        CHECK(residual(h, dofs, solver.solve(b).y, b) < 1e-9 * b.norm());
    }
}

TEST_CASE("under rows an indefinite matrix is solved, for many right-hand sides at once as for each", "[linear_system]") {
    std::mt19937 random(6);
    std::normal_distribution<double> normal;
    for (const double shift : {0.0, 60.0})
        for (const int bodies : {3, 60}) {  // dense, and sparse
            LinearSystem system(chain_of_bodies(bodies));
            const auto h = random_hessian(bodies, shift, random);
            RowJacobian rows;
            for (int i = 0; i + 1 < bodies; ++i) {
                rows.first.push_back(count_of(rows.entries));
                for (const int body : {i, i + 1}) rows.entries.push_back({body, Vector6::NullaryExpr([&] { return normal(random); })});
            }
            rows.first.push_back(count_of(rows.entries));
            CHECK(system.factorise(h, rows) == (shift > 0));
            REQUIRE(system.factorise_any(h, rows));
            const MatrixX r = MatrixX::Random(system.dofs().count, 5), c = MatrixX::Random(rows.count(), 5);
            const LinearSystem::Solution x = system.solve_refined(h, rows, r, c), left = system.residual(h, rows, r, c, x);
            CHECK(left.y.norm() + left.multipliers.norm() <= 1e-12 * (r.norm() + h.diagonal[0].norm() * x.y.norm() + x.multipliers.norm()));
            for (Eigen::Index k = 0; k < 5; ++k) {
                const LinearSystem::Solution one = system.solve_refined(h, rows, r.col(k), c.col(k));
                if (shift > 0) CHECK(one.y == x.y.col(k));
                CHECK((one.y - x.y.col(k)).norm() <= 1e-11 * one.y.norm());
            }
        }
}

TEST_CASE("a singular matrix has no factor", "[linear_system]") {
    for (const int bodies : {2, 40}) {
        LinearSystem system(chain_of_bodies(bodies));
        BlockHessian h;
        h.diagonal.assign(bodies, Matrix6::Identity());
        h.diagonal.back()(5, 5) = 0;
        CHECK_FALSE(system.factorise_any(h));
        CHECK_FALSE(system.is_usable());
        CHECK(system.solve(VectorX::Ones(system.dofs().count)).y.array().isNaN().all());  // told by numbers, not by an assertion
        h.diagonal.back()(5, 5) = std::numeric_limits<double>::infinity();
        CHECK_FALSE(system.factorise_any(h));
        CHECK(system.solve_refined(h, {}, VectorX::Ones(system.dofs().count)).y.array().isNaN().all());
    }
}

TEST_CASE("a new pattern replaces the symbolic factor", "[linear_system]") {
    std::mt19937 random(5);
    const FreeDofs dofs = chain_of_bodies(40);
    LinearSystem solver(dofs);
    auto h = random_hessian(40, 60, random);
    REQUIRE(solver.factorise(h));
    h.off_diagonal.erase(h.off_diagonal.begin() + 5);
    h.off_diagonal.push_back({38, 39, Matrix6::Identity()});
    h.off_diagonal.erase(h.off_diagonal.end() - 2);
    REQUIRE(solver.factorise(h));
    const VectorX b = VectorX::Ones(dofs.count);
    CHECK(residual(h, dofs, solver.solve(b).y, b) < 1e-12 * b.norm());
}

}  // namespace fettle::core::linear::linear_system_test
