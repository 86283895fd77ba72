// SPDX-License-Identifier: MIT
// Repair: the nearest point that meets the constraints, against points known in closed form.
#include "design/optimisers/nearest_design.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/limits.hpp"
#include "design/optimisers/optimisation.hpp"

namespace fettle::design::optimisers::nearest_design_test {

namespace {

using core::base::infinity;

// x^2 + 4 y^2 >= 4, ranges 10 and 5: in units of the ranges the ellipse is a circle of radius 0.2. Its objective is none of repair's.
Problem outside_of_ellipse(double x, double y) {
    Problem p;
    p.start = Vector2(x, y);
    p.lower = Vector2(-5, -2.5);
    p.upper = Vector2(5, 2.5);
    p.constraint_lower = VectorX::Constant(1, 4);
    p.constraint_upper = VectorX::Constant(1, infinity);
    p.evaluate = [](const VectorX& at) {
        Evaluation e;
        e.usable = true;
        e.objective = 100 - at[0];
        e.gradient = Vector2(-1, 0);
        e.constraints = VectorX::Constant(1, at[0] * at[0] + 4 * at[1] * at[1]);
        e.jacobian = MatrixX(1, 2);
        e.jacobian << 2 * at[0], 8 * at[1];
        e.violation = std::max(0.0, 4 - 1e-9 - e.constraints[0]);
        return e;
    };
    return p;
}

}  // namespace

TEST_CASE("the smallest change that meets a constraint is the one along the shortest way, in shares of the ranges") {
    for (const char* name : {"sqp", "ipopt", "slsqp", "cobyla"}) {
        CAPTURE(name);
        const Problem problem = outside_of_ellipse(0.6, 0.4);  // 0.06 and 0.08 of the ranges: on a ray at 0.1 from the middle
        const Problem repair = nearest_to(problem.start, problem);
        OptimiserOptions options;
        options.tolerance = 1e-6;
        const OptimiserReport report = optimise(repair, **make_optimiser(name), options);
        CHECK(report.feasible);
        CHECK(std::sqrt(report.best.objective) == Approx(0.1).epsilon(1e-4));
        CHECK(report.point[0] == Approx(1.2).epsilon(1e-2));
        CHECK(report.point[1] == Approx(0.8).epsilon(1e-2));
        CHECK(squared_change(problem, problem.start, report.point) == Approx(report.best.objective).epsilon(1e-12));
    }
}

TEST_CASE("a requirement that is nearly met is met in the end, however rough the tolerance of the objective") {
    // The logarithm of the same constraint: each linearisation promises more than comes true, so that every step falls a little short.
    for (const double tolerance : {1e-4, 1e-2, 1e-1}) {
        CAPTURE(tolerance);
        Problem problem = outside_of_ellipse(0.6, 0.4);
        problem.constraint_lower = VectorX::Constant(1, std::log(4.0) + 1e-6);  // with a margin, as designs have
        problem.evaluate = [evaluate = problem.evaluate](const VectorX& at) {
            Evaluation e = evaluate(at);
            e.jacobian /= e.constraints[0];
            e.constraints[0] = std::log(e.constraints[0]);
            e.violation = std::max(0.0, std::log(4.0) - e.constraints[0]);
            return e;
        };
        OptimiserOptions options;
        options.tolerance = tolerance;
        const OptimiserReport report = optimise(nearest_to(problem.start, problem), **make_optimiser("sqp"), options);
        CHECK(report.feasible);
        CHECK(std::sqrt(report.best.objective) == Approx(0.1).epsilon(std::max(1e-2, tolerance)));
        CHECK(report.evaluations < 20);
    }
}

TEST_CASE("what meets every constraint is left as it is, after one evaluation") {
    const Problem problem = outside_of_ellipse(3, 1);
    const OptimiserReport report = optimise(nearest_to(problem.start, problem), **make_optimiser("sqp"), {});
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.point == problem.start);
    CHECK(report.evaluations == 1);
    CHECK(report.best.objective == 0);
}

TEST_CASE("a design is nearest to what it is asked to be near to, wherever the run begins") {
    Problem problem = outside_of_ellipse(0.6, 0.4);
    const VectorX origin = problem.start;
    problem.start = Vector2(-3, 2);  // feasible, and far: not the end
    const OptimiserReport report = optimise(nearest_to(origin, problem), **make_optimiser("sqp"), {});
    CHECK(report.feasible);
    CHECK(std::sqrt(report.best.objective) == Approx(0.1).epsilon(1e-2));
}

TEST_CASE("the derivatives of the change are those of its value") {
    const Problem problem = outside_of_ellipse(0.6, 0.4);
    const Problem repair = nearest_to(problem.start, problem);
    const VectorX x = Vector2(1.7, -0.9);
    const Evaluation e = repair.evaluate(x);
    CHECK(e.residuals.squaredNorm() == Approx(e.objective).epsilon(1e-15));
    for (int k = 0; k < 2; ++k) {
        const VectorX h = 1e-4 * VectorX::Unit(2, k);
        const Evaluation above = repair.evaluate(x + h), below = repair.evaluate(x - h);
        CHECK(e.gradient[k] == Approx((above.objective - below.objective) / 2e-4).epsilon(1e-9));
        CHECK((e.residual_jacobian.col(k) - (above.residuals - below.residuals) / 2e-4).norm() < 1e-10);
    }
    CHECK(e.constraints == problem.evaluate(x).constraints);
}

TEST_CASE("the change of an angle is the shorter way round, and one of a fixed variable is none") {
    Problem p;
    p.lower = Vector2(0, 3);
    p.upper = Vector2(6, 3);
    p.periodic = {true, false};
    CHECK(squared_change(p, Vector2(5.9, 3), Vector2(0.2, 3)) == Approx(0.05 * 0.05));
    p.periodic = {};
    CHECK(squared_change(p, Vector2(5.9, 3), Vector2(0.2, 3)) == Approx(0.95 * 0.95));
}

}  // namespace fettle::design::optimisers::nearest_design_test
