// SPDX-License-Identifier: MIT
#include "fettle/core/solver/linear_solver.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <random>

#include "fettle/tests/support/test_models.hpp"

namespace fettle::core::solver::linear_solver_test {

using namespace fettle::tests::support;

namespace {

model::Model chain_of_bodies(int n) {
    model::Model model;
    for (int i = 0; i < n; ++i) {
        model::Body body =
            make_body("b" + std::to_string(i), box_mesh(Vector3::Zero(), Vector3::Ones()), make_pose(Vector3::Zero(), Vector3::Zero()));
        if (i % 5 == 2) prescribe(body, i % 6);
        model.bodies.push_back(body);
    }
    return model;
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

TEST_CASE("dense and sparse factorisations solve the free part", "[linear_solver]") {
    std::mt19937 random(3);
    for (int bodies : {1, 6, 40}) {  // 6 to 234 free DOFs: both sides of the switch
        const FreeDofs dofs = free_dofs(chain_of_bodies(bodies));
        LinearSolver solver(dofs);
        for (int repeat = 0; repeat < 3; ++repeat) {  // the symbolic factor is reused
            const auto h = random_hessian(bodies, 60, random);
            REQUIRE(solver.factorise(h));
            const VectorX b = VectorX::LinSpaced(dofs.count, -1, 2);
            CHECK(residual(h, dofs, solver.solve(b), b) < 1e-12 * b.norm());
        }
    }
}

TEST_CASE("an indefinite matrix is refused by Cholesky and solved by the other factorisation", "[linear_solver]") {
    std::mt19937 random(4);
    for (int bodies : {3, 40}) {
        const FreeDofs dofs = free_dofs(chain_of_bodies(bodies));
        LinearSolver solver(dofs);
        const auto h = random_hessian(bodies, 0, random);
        CHECK_FALSE(solver.factorise(h));
        REQUIRE(solver.factorise_indefinite(h));
        const VectorX b = VectorX::LinSpaced(dofs.count, -1, 2);
        CHECK(residual(h, dofs, solver.solve(b), b) < 1e-9 * b.norm());
    }
}

TEST_CASE("a new pattern replaces the symbolic factor", "[linear_solver]") {
    std::mt19937 random(5);
    const FreeDofs dofs = free_dofs(chain_of_bodies(40));
    LinearSolver solver(dofs);
    auto h = random_hessian(40, 60, random);
    REQUIRE(solver.factorise(h));
    h.off_diagonal.erase(h.off_diagonal.begin() + 5);
    h.off_diagonal.push_back({38, 39, Matrix6::Identity()});
    h.off_diagonal.erase(h.off_diagonal.end() - 2);
    REQUIRE(solver.factorise(h));
    const VectorX b = VectorX::Ones(dofs.count);
    CHECK(residual(h, dofs, solver.solve(b), b) < 1e-12 * b.norm());
}

}  // namespace fettle::core::solver::linear_solver_test
