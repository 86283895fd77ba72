// SPDX-License-Identifier: MIT
#include "core/expression/tape.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/derivative_check.hpp"

namespace fettle::core::expression::tape_test {

namespace {

// Something of every operation.
template <class T>
T sample(const T& x, const T& y) {
    using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::exp, std::hypot, std::log, std::pow, std::sin, std::sqrt,
        std::tan;
    T out = x * y + x / y - (-x) + 2.0 * sqrt(x + y) + abs(x - y) + sin(x) * cos(y) + tan(x / 10.0);
    out += asin(x / 10.0) + acos(y / 10.0) + atan(x) + exp(x / y) + log(x * y) + pow(x, 2.5) + pow(2.0, y) + pow(x, y);
    out += minimum(x, y) + maximum(2.0 * x, y) + atan2(x, y) + hypot(x, y) + choose(x - y, x * x, y * y);
    return out;
}

}  // namespace

TEST_CASE("what is recorded gives the same numbers again, at other inputs too") {
    Tape tape;
    const Number x = tape.input(1.25), y = tape.input(2.25);
    const Number z = sample(x, y);
    CHECK(z.value == sample(1.25, 2.25));
    for (const auto& inputs : {std::array{1.25, 2.25}, std::array{3.0, 0.75}}) {
        const std::vector<double> at = values<double>(tape.nodes(), inputs);
        CHECK(at[z.node] == sample(inputs[0], inputs[1]));
    }
}

TEST_CASE("gradients forwards and backwards are those of differences, on both sides of kinks") {
    Tape tape;
    const Number x = tape.input(1.25), y = tape.input(2.25);
    const Number z = sample(x, y);
    for (const auto& inputs : {std::array{1.25, 2.25}, std::array{3.0, 0.75}}) {
        const std::vector<double> at = values<double>(tape.nodes(), inputs);
        const VectorX forwards = gradients(tape.nodes(), at, 2).col(z.node);
        std::vector<double> weights(at.size(), 0);
        weights[z.node] = 1;
        const VectorX backwards = weighted_gradient(tape.nodes(), at, weights, 2);
        CHECK((forwards - backwards).norm() <= 1e-13 * forwards.norm());
        const auto check = tests::support::check_gradient([](const VectorX& p) { return sample(p[0], p[1]); },
                                                          VectorX(Vector2(inputs[0], inputs[1])), forwards, {1e-2, 0.25, 10});
        INFO(check.column << ": " << check.analytic << " against " << check.difference);
        CHECK(check.relative_error < 1e-9);
    }
}

TEST_CASE("constants cost nothing, and what changes nothing is not recorded") {
    Tape tape;
    const Number x = tape.input(2);
    const Number two = Number(1) + 1;
    CHECK(two.is_constant());
    CHECK((x * 1 + 0).node == x.node);
    CHECK((x * 0).is_constant());
    CHECK((x / 1 - 0).node == x.node);
    CHECK(tape.nodes().size() == 1);
    CHECK((x * two).value == 4);
}

}  // namespace fettle::core::expression::tape_test
