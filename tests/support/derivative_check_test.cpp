// SPDX-License-Identifier: MIT
/// The checker must accept right derivatives and reject wrong ones, also those that are only slightly wrong.
#include "tests/support/derivative_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace fettle::tests::support::derivative_check_test {

namespace {

double f(const VectorX& x) { return std::exp(x[0]) * std::sin(x[1]) + x[0] * x[2] * x[2]; }
VectorX f_gradient(const VectorX& x) {
    VectorX g(3);
    g << std::exp(x[0]) * std::sin(x[1]) + x[2] * x[2], std::exp(x[0]) * std::cos(x[1]), 2 * x[0] * x[2];
    return g;
}
MatrixX f_hessian(const VectorX& x) {
    const double e = std::exp(x[0]), s = std::sin(x[1]), c = std::cos(x[1]);
    MatrixX h(3, 3);
    h << e * s, e * c, 2 * x[2], e * c, -e * s, 0, 2 * x[2], 0, 2 * x[0];
    return h;
}
const VectorX point = Eigen::Vector3d(0.3, 1.1, -0.7);

}  // namespace

TEST_CASE("a right gradient and Hessian pass to 1e-9", "[support]") {
    CHECK(check_gradient(f, point, f_gradient(point)).relative_error < 1e-9);
    CHECK(check_jacobian(f_gradient, point, f_hessian(point)).relative_error < 1e-9);
    const VectorX v = Eigen::Vector3d(1, -2, 0.5);
    CHECK(check_directional(f_gradient, point, v, f_hessian(point) * v).relative_error < 1e-9);
}

TEST_CASE("a wrong gradient is rejected, and its worst entry named", "[support]") {
    VectorX wrong = f_gradient(point);
    wrong[1] += 1e-5;
    const DerivativeCheck check = check_gradient(f, point, wrong);
    CHECK(check.relative_error > 1e-6);
    CHECK(check.column == 1);
    CHECK(check.analytic - check.difference == Approx(1e-5).epsilon(0.1));  // the best step's truncation hides a little of it
    CHECK(check_gradient(f, point, -f_gradient(point)).relative_error > 1);
    CHECK(check_gradient(f, point, VectorX::Zero(3)).relative_error == Approx(1));
}

TEST_CASE("a wrong Hessian entry and a transposed Jacobian are rejected", "[support]") {
    MatrixX wrong = f_hessian(point);
    wrong(2, 0) *= 1 + 1e-4;
    CHECK(check_jacobian(f_gradient, point, wrong).relative_error > 1e-6);
    const MatrixX j = (MatrixX(2, 2) << 1, 2, 3, 4).finished();
    const auto linear = [&](const VectorX& x) -> VectorX { return j * x; };
    CHECK(check_jacobian(linear, VectorX::Ones(2), j).relative_error < 1e-12);
    CHECK(check_jacobian(linear, VectorX::Ones(2), j.transpose()).relative_error > 0.1);
}

TEST_CASE("a derivative that is not finite is rejected", "[support]") {
    VectorX wrong = f_gradient(point);
    wrong[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isinf(check_gradient(f, point, wrong).relative_error));
    CHECK_FALSE(check_taylor(f, point, wrong, VectorX::Ones(3)).ok());
    const auto nowhere = [](const VectorX&) { return std::numeric_limits<double>::quiet_NaN(); };
    CHECK(std::isinf(check_gradient(nowhere, point, f_gradient(point)).relative_error));
}

TEST_CASE("the transpose identity tells J^T from what is not", "[support]") {
    const MatrixX j = MatrixX::NullaryExpr(4, 3, [](Eigen::Index r, Eigen::Index c) { return std::sin(double(3 * r + c)); });
    const auto times = [&](const VectorX& v) -> VectorX { return j * v; };
    CHECK(check_transpose(
              times, [&](const VectorX& w) -> VectorX { return j.transpose() * w; }, 3, 4) < 1e-15);
    MatrixX wrong = j;
    wrong(2, 1) += 1e-6;
    CHECK(check_transpose(
              times, [&](const VectorX& w) -> VectorX { return wrong.transpose() * w; }, 3, 4) > 1e-8);
}

TEST_CASE("the Taylor remainder of a right gradient has slope 2, of a wrong one slope 1", "[support]") {
    const VectorX d = Eigen::Vector3d(0.5, 1, -1);
    const TaylorCheck right = check_taylor(f, point, f_gradient(point), d);
    CHECK(right.ok());
    CHECK(right.slope == Approx(2).margin(0.05));
    VectorX wrong = f_gradient(point);
    wrong[2] *= 1.001;
    const TaylorCheck check = check_taylor(f, point, wrong, d);
    CHECK_FALSE(check.ok());
    CHECK(check.slope == Approx(1).margin(0.2));
}

TEST_CASE("an affine function has no remainder, with a wrong gradient slope 1", "[support]") {
    const auto affine = [](const VectorX& x) { return 3 * x[0] - 2 * x[1] + 5; };
    const VectorX d = Eigen::Vector2d(0.3, 0.4), g = Eigen::Vector2d(3, -2), wrong = Eigen::Vector2d(3, -2.01);
    CHECK(check_taylor(affine, VectorX::Ones(2), g, d).below_rounding);
    CHECK(check_taylor(affine, VectorX::Ones(2), g, d).ok());
    CHECK_FALSE(check_taylor(affine, VectorX::Ones(2), wrong, d).ok());
}

}  // namespace fettle::tests::support::derivative_check_test
