// SPDX-License-Identifier: MIT
#include "design/optimisers/least_squares.hpp"

#include <cmath>

#include "tests/design/optimisers/known_problems.hpp"

namespace fettle::design::optimisers::least_squares_test {

namespace {

using namespace fettle::tests::design_support;

// f = sum r^2 of residuals r(x), and their derivatives.
Problem squares(const VectorX& start, const VectorX& lower, const VectorX& upper, std::function<Rows(const VectorX&)> residuals) {
    Problem p;
    p.start = start;
    p.lower = lower;
    p.upper = upper;
    p.evaluate = [residuals = std::move(residuals), n = start.size()](const VectorX& x) {
        const Rows rows = residuals(x);
        Evaluation e;
        e.usable = true;
        e.residuals = rows.values;
        e.residual_jacobian = rows.jacobian;
        e.objective = rows.values.squaredNorm();
        e.gradient = 2 * rows.jacobian.transpose() * rows.values;
        e.constraints.resize(0);
        e.jacobian.resize(0, n);
        return e;
    };
    return p;
}

// 100 (y - x^2)^2 + (1 - x)^2: a valley that curves.
Rows valley(const VectorX& x) {
    Rows rows{Vector2(10 * (x[1] - x[0] * x[0]), 1 - x[0]), MatrixX(2, 2)};
    rows.jacobian << -20 * x[0], 10, -1, 0;
    return rows;
}

// (cos a - cos goal, sin a - sin goal), the angle of a point on a circle.
std::function<Rows(const VectorX&)> angle_to(double goal) {
    return [goal](const VectorX& x) {
        Rows rows{Vector2(std::cos(x[0]) - std::cos(goal), std::sin(x[0]) - std::sin(goal)), MatrixX(2, 1)};
        rows.jacobian << -std::sin(x[0]), std::cos(x[0]);
        return rows;
    };
}

}  // namespace

TEST_CASE("least squares: a curved valley is followed in at most twice the evaluations that scipy's trf takes") {
    constexpr int scipys = 25;  // least_squares(..., (-1.2, 1), bounds=(-5, 5), method="trf", ftol=1e-7), nfev of SciPy 1.10
    for (const char* name : {"sqp", "gauss_newton"}) {
        INFO(name);
        const OptimiserReport report =
            run(squares(Vector2(-1.2, 1), VectorX::Constant(2, -5), VectorX::Constant(2, 5), valley), name, tight(200));
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK((report.point - Vector2(1, 1)).norm() < 1e-4);
        REQUIRE(report.stages.size() == 1);
        CHECK(report.evaluations <= 2 * scipys);  // the verdict's among them
    }
}

TEST_CASE("least squares: bounds hold what they hold, and no more") {
    Problem p = squares(Vector2(-1.2, 1), VectorX::Constant(2, -5), Vector2(0.5, 5), valley);
    const OptimiserReport report = run(p, "gauss_newton", tight(200));
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.point[0] == Approx(0.5).margin(1e-6));
    CHECK(report.point[1] == Approx(0.25).margin(1e-4));
    CHECK(report.optimality.held[0] == Held::upper_bound);
    CHECK(report.optimality.held[1] != Held::upper_bound);
}

TEST_CASE("least squares: residuals that do not vanish end at the least sum") {
    // (x - 1, 2 (x + 1), x^2): the least of 5 x^2 + 6 x + 5 + x^4 is where 4 x^3 + 10 x + 6 = 0.
    const auto residuals = [](const VectorX& x) {
        Rows rows{Vector3(x[0] - 1, 2 * (x[0] + 1), x[0] * x[0]), MatrixX(3, 1)};
        rows.jacobian << 1, 2, 2 * x[0];
        return rows;
    };
    const OptimiserReport report =
        run(squares(VectorX::Constant(1, 3), VectorX::Constant(1, -4), VectorX::Constant(1, 4), residuals), "sqp", tight(100));
    CHECK(report.status == OptimiserStatus::optimal);
    const double x = report.point[0];
    CHECK(std::abs(4 * x * x * x + 10 * x + 6) < 1e-2);
}

TEST_CASE("an angle goes through the wall that its bounds are not, with every optimiser, and is told within its period") {
    const double turn = 2 * std::acos(-1.0);
    for (const OptimiserInfo& info : optimiser_table()) {
        INFO(info.name);
        Problem p = squares(VectorX::Constant(1, 0.3), VectorX::Zero(1), VectorX::Constant(1, turn), angle_to(turn - 0.4));
        p.periodic = {true};
        OptimiserOptions options = tight(200);
        const OptimiserReport report = run(p, info.name, options);
        CHECK(report.best.objective < 1e-8);
        CHECK(report.point[0] == Approx(turn - 0.4).margin(1e-3));
        p.periodic = {};
        if (info.name != "sqp") continue;
        CHECK(run(p, info.name, options).point[0] == Approx(0).margin(1e-6));  // the wall, where it is one
    }
}

TEST_CASE("least squares: points that cannot be evaluated shorten the step, and none is taken for a number") {
    Problem p = squares(Vector2(-1.2, 1), VectorX::Constant(2, -5), VectorX::Constant(2, 5), valley);
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        if (x[1] < -0.5) {
            e = {};
            e.reason = "too low";
        }
        return e;
    };
    const OptimiserReport report = run(p, "gauss_newton", tight(200));
    CHECK(report.failures > 0);
    CHECK((report.point - Vector2(1, 1)).norm() < 1e-4);
}

TEST_CASE("least squares: a sum that vanishes is optimal, whatever stands around it") {
    const VectorX one = VectorX::Ones(2);
    Problem p = squares(Vector2(0.9, -0.7), -one, one, [](const VectorX& x) { return Rows{x, MatrixX::Identity(2, 2)}; });
    p.evaluate = [inner = p.evaluate](const VectorX& x) {
        Evaluation e = inner(x);
        e.usable = x.norm() > 0.1 || x.norm() < 1e-5;  // nothing next to the least point: no noise can be measured there
        return e;
    };
    const OptimiserReport report = run(p, "gauss_newton", tight(60));
    CHECK(report.best.objective < 1e-16);
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.optimality.judged);
    CHECK(report.optimality.held.size() == 2);
    CHECK(report.optimality.residual.size() == 2);
    CHECK(report.optimality.step.size() == 2);
}

TEST_CASE("least squares: is it one?") {
    Evaluation e = squares(Vector2(0, 0), {}, {}, valley).evaluate(Vector2(0.5, 0.5));
    CHECK(is_sum_of_squares(e));
    e.objective += 0.1;
    CHECK_FALSE(is_sum_of_squares(e));
    e.objective -= 0.1;
    e.has_derivatives = false;
    CHECK_FALSE(is_sum_of_squares(e));
}

}  // namespace fettle::design::optimisers::least_squares_test
