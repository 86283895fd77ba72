// SPDX-License-Identifier: MIT
#include "design/optimisers/sequential_optimiser.hpp"

#include <cmath>

#include "tests/design/optimisers/known_problems.hpp"

namespace fettle::design::optimisers::sequential_optimiser_test {

namespace {

using namespace fettle::tests::design_support;

// Maratos' problem: min 2 (x^2 + y^2 - 1) - x over x^2 + y^2 = 1, at (1, 0) with f = -1. From a point on the circle a full step, however
// good, raises both f and the violation.
Problem on_circle(double angle) {
    Problem p;
    p.start = Vector2(std::cos(angle), std::sin(angle));
    p.lower = VectorX::Constant(2, -2);
    p.upper = VectorX::Constant(2, 2);
    p.constraint_lower = p.constraint_upper = VectorX::Ones(1);
    p.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = 2 * (x.squaredNorm() - 1) - x[0];
        e.gradient = 4 * x - Vector2(1, 0);
        e.constraints = VectorX::Constant(1, x.squaredNorm());
        e.jacobian = 2 * x.transpose();
        e.violation = std::max(0.0, std::abs(x.squaredNorm() - 1) - 1e-6);
        return e;
    };
    return p;
}

// The same with a second variable along a helix: min -z over the cylinder x^2 + y^2 = 1 and z = angle/10 of the point, z <= 0.2. A long way
// along a curve of constraints.
Problem along_helix() {
    Problem p;
    p.start = Vector3(1, 0, 0);
    p.lower = Vector3(-2, -2, -1);
    p.upper = Vector3(2, 2, 0.2);
    p.constraint_lower = p.constraint_upper = Vector2(1, 0);
    p.evaluate = [](const VectorX& x) {
        Evaluation e;
        e.usable = true;
        e.objective = -x[2];
        e.gradient = Vector3(0, 0, -1);
        const double square = x[0] * x[0] + x[1] * x[1];
        e.constraints = Vector2(square, x[2] - 0.1 * std::atan2(x[1], x[0]));
        e.jacobian.resize(2, 3);
        e.jacobian << 2 * x[0], 2 * x[1], 0, 0.1 * x[1] / square, -0.1 * x[0] / square, 1;
        e.violation = std::max({0.0, std::abs(square - 1) - 1e-6, std::abs(e.constraints[1]) - 1e-6});
        return e;
    };
    return p;
}

}  // namespace

TEST_CASE("sqp: steps along a curved constraint are corrected, not refused") {
    for (const double angle : {0.5, 1.0, 2.0, 3.0}) {
        const OptimiserReport report = run(on_circle(angle), "sqp", tight(200));
        INFO(angle << ": " << to_string(report.status) << ", " << report.evaluations << " evaluations");
        CHECK(report.status == OptimiserStatus::optimal);
        CHECK(report.best.objective == Approx(-1).margin(1e-5));
        CHECK(report.evaluations < 40);  // 61 to 198 without corrections
    }
}

TEST_CASE("sqp: a long way along a curve of constraints") {
    const OptimiserReport report = run(along_helix(), "sqp", tight(200));
    INFO(to_string(report.status) << ", " << report.message << ", " << report.evaluations << " evaluations");
    CHECK(report.status == OptimiserStatus::optimal);
    CHECK(report.best.objective == Approx(-0.2).margin(1e-6));
    CHECK(report.evaluations < 40);  // 61 to 198 without corrections
}

}  // namespace fettle::design::optimisers::sequential_optimiser_test
