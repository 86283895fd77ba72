// SPDX-License-Identifier: MIT
// CHOLMOD's factor against the one by blocks, on grids in which every body touches all its neighbours; what the linear system takes for
// them. Without CHOLMOD on OpenBLAS there is nothing to compare.
#include "core/linear/supernodal_cholesky.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/base/parallel.hpp"
#include "core/linear/block_cholesky.hpp"
#include "core/linear/linear_system.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::linear::supernodal_cholesky_test {

namespace {

struct Grid {
    BlockHessian hessian;
    FreeDofs dofs;
};

// n^3 bodies, each coupled with all 26 around it; of some not everything is free. Positive definite by its diagonal.
Grid grid(int n, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Grid out;
    const auto number = [n](int i, int j, int k) { return (i * n + j) * n + k; };
    const auto is_in = [n](int i) { return i >= 0 && i < n; };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                const int a = number(i, j, k);
                const bool held = random() % 31 == 0, guided = random() % 11 == 0;
                out.dofs.add_body([&](int dof) { return !held && !(guided && dof < 2); });
                out.hessian.diagonal.push_back(200 * Matrix6::Identity());
                for (int m = 14; m < 27; ++m) {  // those after it
                    const int x = i + m / 9 - 1, y = j + m / 3 % 3 - 1, z = k + m % 3 - 1;
                    if (is_in(x) && is_in(y) && is_in(z))
                        out.hessian.off_diagonal.push_back({a, number(x, y, z), Matrix6::NullaryExpr([&] { return unit(random); })});
                }
            }
    return out;
}

}  // namespace

TEST_CASE("CHOLMOD's factor solves as the one by blocks does", "[supernodal]") {
    if (!SupernodalCholesky::is_available()) FETTLE_SKIP("no CHOLMOD on OpenBLAS: nothing to compare");
    std::mt19937 random(21);
    for (const int n : {1, 2, 5}) {
        Grid g = grid(n, random);
        BlockCholesky blocks;
        SupernodalCholesky factor;
        blocks.analyse(g.hessian, g.dofs);
        for (const double operations : {blocks.operations(), 0.0}) {  // 0: in the order of the blocks
            factor.analyse(g.hessian, g.dofs, blocks.order(), operations);
            for (int change = 0; change < 2; ++change) {
                g.hessian.diagonal[0] += Matrix6::Identity();
                REQUIRE(blocks.factorise(g.hessian, g.dofs));
                REQUIRE(factor.factorise(g.hessian, g.dofs));
                const MatrixX rhs = MatrixX::Random(g.dofs.count, 3), expected = blocks.solve(rhs, g.dofs);
                CHECK((factor.solve(rhs) - expected).norm() <= 1e-13 * expected.norm());
            }
        }
        if (g.dofs.count == 0) continue;
        Grid indefinite = g, no_number = g;
        indefinite.hessian.diagonal.back() -= 400 * Matrix6::Identity();
        no_number.hessian.diagonal.back()(5, 5) = std::numeric_limits<double>::quiet_NaN();
        CHECK(factor.factorise(indefinite.hessian, g.dofs) == blocks.factorise(indefinite.hessian, g.dofs));
        CHECK(factor.factorise(no_number.hessian, g.dofs) == blocks.factorise(no_number.hessian, g.dofs));
        CHECK(factor.factorise(g.hessian, g.dofs));
    }
}

TEST_CASE("many bodies that hang together are solved with the same bits for any number of threads", "[supernodal][linear_system]") {
    std::mt19937 random(22);
    Grid g = grid(9, random);
    BlockCholesky blocks;
    blocks.analyse(g.hessian, g.dofs);
    REQUIRE(blocks.operations() > LinearSystem::supernodal_operations);
    const MatrixX rhs = MatrixX::Random(g.dofs.count, 2);
    std::vector<MatrixX> solutions;
    for (const int threads : {1, 2}) {
        const base::ThreadLimit limit(threads);
        LinearSystem system(g.dofs);
        REQUIRE(system.factorise(g.hessian));
        solutions.push_back(system.solve_refined(g.hessian, {}, rhs).y);
    }
    CHECK(solutions[0] == solutions[1]);
    REQUIRE(blocks.factorise(g.hessian, g.dofs));
    CHECK((solutions[0] - blocks.solve(rhs, g.dofs)).norm() <= 1e-13 * solutions[0].norm());
    g.hessian.off_diagonal.erase(g.hessian.off_diagonal.begin() + 1000, g.hessian.off_diagonal.begin() + 1010);  // another graph
    LinearSystem system(g.dofs);
    REQUIRE(system.factorise(g.hessian));
    const LinearSystem::Solution x = system.solve(rhs);
    CHECK(system.residual(g.hessian, {}, rhs, {}, x).y.norm() <= 1e-13 * rhs.norm());
}

}  // namespace fettle::core::linear::supernodal_cholesky_test
