// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/dual.hpp"

#include <catch2/catch.hpp>

#include "fettle/core/base/types.hpp"
#include "fettle/tests/support/derivative_check.hpp"

namespace fettle::design::shapes::dual_test {

namespace {

// Uses every operation, both orders of mixing with constants, and the compound forms.
template <class Scalar>
Scalar everything(const Scalar& x, const Scalar& y) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    Scalar sum = sqrt(x * x + 2.0 * y) * sin(x / y) - cos(x * y);
    sum += 3.0 / (x + 1.0);
    sum -= y / 4.0;
    sum *= -x;
    sum /= 1.5 - -y;
    return +sum + (2.0 - x) + (y - 1.0);
}

template <int Size>
VectorX gradient_of_everything(const VectorX& at) {
    return everything(Dual<Size>::variable(at[0], 0, 2), Dual<Size>::variable(at[1], 1, 2)).gradient;
}

double value_of_everything(const VectorX& at) { return everything(at[0], at[1]); }

TEST_CASE("dual: value and gradient of an expression with every operation") {
    for (const Vector2& point : {Vector2(0.7, 1.3), Vector2(2.5, 0.4), Vector2(-1.9, 3.1)}) {
        const VectorX at = point;
        CHECK(everything(Dual<>::variable(at[0], 0, 2), Dual<>::variable(at[1], 1, 2)).value == value_of_everything(at));
        CHECK(tests::support::check_gradient(value_of_everything, at, gradient_of_everything<Eigen::Dynamic>(at)).relative_error < 1e-9);
        CHECK(gradient_of_everything<2>(at) == gradient_of_everything<Eigen::Dynamic>(at));
    }
}

TEST_CASE("dual: known derivatives") {
    const auto x = Dual<>::variable(0.5, 0, 1);
    CHECK(sin(x).derivative(0) == std::cos(0.5));
    CHECK(cos(x).derivative(0) == -std::sin(0.5));
    CHECK(sqrt(x).derivative(0) == Approx(0.5 / std::sqrt(0.5)).epsilon(1e-15));
    CHECK((1.0 / x).derivative(0) == -4.0);
    CHECK((x * x * x).derivative(0) == 0.75);
    CHECK((x - x).derivative(0) == 0.0);
}

TEST_CASE("dual: a constant has no gradient and goes with any") {
    const Dual<> constant = 3.0;
    CHECK(constant.derivative(7) == 0.0);
    CHECK((constant * 2.0 - 1.0).value == 5.0);
    CHECK((constant * 2.0).gradient.size() == 0);
    const auto y = Dual<>::variable(2.0, 1, 3);
    const Vector3 expected(0, 3, 0);
    CHECK((constant * y).gradient == expected);
    CHECK((y * constant).gradient == expected);
    CHECK((y - constant).gradient == Vector3(0, 1, 0));
    CHECK((constant - y).gradient == Vector3(0, -1, 0));
}

TEST_CASE("dual: comparisons look at the value only") {
    const auto a = Dual<>::variable(1.0, 0, 2), b = Dual<>::variable(1.0, 1, 2);
    CHECK(a == b);
    CHECK(a <= b);
    CHECK(a >= b);
    CHECK_FALSE(a != b);
    CHECK(a < b + 0.5);
    CHECK(b + 0.5 > a);
    CHECK(a < 2.0);
}

TEST_CASE("dual: inputs of different problems do not mix") {
    CHECK_THROWS_AS(Dual<>::variable(1, 0, 2) + Dual<>::variable(1, 0, 3), core::base::ContractError);
    CHECK_THROWS_AS(Dual<>::variable(1, 2, 2), core::base::ContractError);
    CHECK_THROWS_AS(Dual<3>::variable(1, 0, 2), core::base::ContractError);
}

}  // namespace

}  // namespace fettle::design::shapes::dual_test
