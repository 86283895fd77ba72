// SPDX-License-Identifier: MIT
#include "design/optimisers/ipopt_optimiser.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "design/optimisers/quadratic_program.hpp"
#include "tests/design/optimisers/known_problems.hpp"

namespace fettle::design::optimisers::ipopt_optimiser_test {

namespace {

using namespace fettle::tests::design_support;

// min sum_k (x_k - k)^2 / 2 over [0, 1.5]^4 with x_0 + ... + x_3 = 3 as a relation. With y the multiplier of the sum, x_k is k - y
// within the bounds: (0, 0.25, 1.25, 1.5) at y = 0.75, which has the sum 3.
Problem nearest_with_sum() {
    Problem p;
    p.start = VectorX::Constant(4, 0.3);
    p.lower = VectorX::Zero(4);
    p.upper = VectorX::Constant(4, 1.5);
    p.relation_lower = p.relation_upper = VectorX::Constant(1, 3);
    p.relations = [](const VectorX& x) { return Rows{VectorX::Constant(1, x.sum()), MatrixX::Ones(1, 4)}; };
    p.evaluate = [](const VectorX& x) {
        const VectorX from = x - VectorX::LinSpaced(4, 0, 3);
        Evaluation e;
        e.usable = true;
        e.objective = 0.5 * from.squaredNorm();
        e.gradient = from;
        e.jacobian.resize(0, 4);
        e.violation = std::max(0.0, std::abs(x.sum() - 3) - 1e-6);
        return e;
    };
    return p;
}

OptimiserReport optimised(const Problem& problem, const OptimiserOptions& options = tight(100)) {
    return optimise(problem, IpoptOptimiser(), options);
}

}  // namespace

TEST_CASE("Ipopt finds an optimum known in closed form, with bounds and a relation that hold it") {
    const OptimiserReport report = optimised(nearest_with_sum());
    INFO(report.message << ", " << report.evaluations << " evaluations");
    CHECK(report.status == OptimiserStatus::optimal);
    const VectorX expected = (VectorX(4) << 0, 0.25, 1.25, 1.5).finished();
    CHECK((report.point - expected).lpNorm<Eigen::Infinity>() < 1e-4);
    CHECK(report.iterations > 1);
    CHECK(report.message.find("ipopt: ") == 0);
}

TEST_CASE("what is refused is not evaluated, and Ipopt shortens its step") {
    Problem p = disc_with_cliff(1.6);
    int refused = 0;
    p.refusal = [&](const VectorX& x) {
        if (x.sum() > 1.6) ++refused;
        return x.sum() > 1.6 ? std::string("beyond the cliff") : std::string();
    };
    const OptimiserReport report = optimised(p);
    CHECK(refused > 0);
    CHECK(report.failures == 0);
    CHECK(report.best.objective == Approx(-std::sqrt(2.0)).epsilon(1e-4));
}

TEST_CASE("a start on a bound, next to which Ipopt's first point fails, is begun from nearer by") {
    Problem p = disc_with_cliff(infinity);
    p.start = (VectorX(2) << -0.5, -2).finished();
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.usable = x[1] <= -1.995 || x[0] > 0;  // Ipopt begins at -1.96
        return e;
    };
    const OptimiserReport report = optimised(p);
    CHECK(report.failures > 0);
    CHECK(report.evaluations > 5);
    CHECK(report.best.violation < 3.25);  // the start has 3.25

    p.refusal = [](const VectorX& x) { return x[1] <= -1.995 || x[0] > 0 ? std::string() : std::string("too thin"); };
    const OptimiserReport refused = optimised(p);
    CHECK(refused.failures < report.failures);
    CHECK(refused.best.violation < 3.25);
}

TEST_CASE("more equations than variables end the run with that reason") {
    Problem p = disc_with_cliff(infinity);
    p.relation_lower = p.relation_upper = VectorX::LinSpaced(3, 1, 3);
    p.relations = [](const VectorX& x) { return Rows{VectorX::Constant(3, x[0]), MatrixX::Identity(3, 2)}; };
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.violation = 1;
        return e;
    };
    const OptimiserReport report = optimised(p);
    CHECK(report.status == OptimiserStatus::infeasible);
    CHECK(report.message == "ipopt: there are more equations than parameters");
}

TEST_CASE("an evaluation may itself have Ipopt solve something") {
    Problem p = nearest_with_sum();
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        QuadraticProgram program;
        program.gradient = VectorX::Ones(2);
        program.hessian = MatrixX::Identity(2, 2);
        program.rows.resize(0, 2);
        program.box_lower = VectorX::Constant(2, -0.5);
        program.box_upper = VectorX::Constant(2, 0.5);
        CHECK(solve(program).step.isApprox(VectorX::Constant(2, -0.5), 1e-6));
        return inner(x);
    };
    CHECK(optimised(p).point == optimised(nearest_with_sum()).point);
}

TEST_CASE("runs of several threads at once have the bits of one alone") {
    const VectorX alone = optimised(nearest_with_sum()).point, alone_by_steps = run(disc_with_cliff(1.6), "sqp", tight(100)).point;
    constexpr size_t count = 4;
    std::vector<VectorX> whole(count), by_steps(count);
    std::vector<std::thread> threads;
    for (size_t k = 0; k < count; ++k) {
        threads.emplace_back([&, k] {
            for (int round = 0; round < 5; ++round) {
                whole[k] = optimised(nearest_with_sum()).point;
                by_steps[k] = optimise(disc_with_cliff(1.6), **make_optimiser("sqp"), tight(100)).point;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (size_t k = 0; k < count; ++k) {
        CHECK(whole[k] == alone);
        CHECK(by_steps[k] == alone_by_steps);
    }
}

}  // namespace fettle::design::optimisers::ipopt_optimiser_test
