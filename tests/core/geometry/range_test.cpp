// SPDX-License-Identifier: MIT
// Ranges contain what formulas give for any numbers of their operands, by sampling; where nothing is known they say so.
#include "core/geometry/range.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/expression/parse_formula.hpp"

namespace fettle::core::geometry::range_test {

namespace {

expression::Formula formula_of(const std::string& text) {
    expression::Scope scope;
    scope.names = {{"x", {}}, {"y", {}}};
    const auto formula = expression::parse_formula(text, scope);
    for (const Error& error : formula.errors()) UNSCOPED_INFO(text + ": " + error.message);
    REQUIRE(formula);
    return *formula;
}

}  // namespace

TEST_CASE("a range contains the formula's value at every point of its operands") {
    std::mt19937_64 random(11);
    const std::vector<std::string> texts{"x + y",
                                         "x - 2 * y",
                                         "x * y",
                                         "x / y",
                                         "1 / (x - y)",
                                         "sqrt(x^2 + y^2)",
                                         "sqrt(x)",
                                         "abs(x) - y",
                                         "sin(x) * y",
                                         "cos(x + y)",
                                         "tan(x)",
                                         "asin(x) / 1 rad",
                                         "acos(y) / 1 rad",
                                         "atan(x) / 1 rad",
                                         "atan2(y, x) / 1 rad",
                                         "atan2(x, y) / 1 rad",
                                         "exp(x)",
                                         "log(x)",
                                         "x^2",
                                         "x^3",
                                         "x^(-2)",
                                         "x^(-3)",
                                         "x^0.5",
                                         "x^(-1.5)",
                                         "x^y",
                                         "hypot(x, y)",
                                         "min(x, y)",
                                         "max(x, y, 0.3)",
                                         "if(x < y, x, 2 * y)",
                                         "if(x > 0.1, y, x)"};
    int checked = 0;
    for (const std::string& text : texts) {
        const expression::Formula formula = formula_of(text);
        for (int run = 0; run < 400; ++run) {
            const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
            const double width = std::pow(10, draw(-16, 0.5));
            std::vector<Range> bounds;
            for (std::size_t k = 0; k < formula.inputs.size(); ++k) {
                const double low = draw(-2, 2);
                bounds.emplace_back(low, low + width * draw(0, 1));
            }
            const Range found = expression::value_of<Range>(formula, bounds);
            REQUIRE(found.low <= found.high);
            for (int sample = 0; sample < 8; ++sample) {
                std::vector<double> inputs;
                for (const Range& bound : bounds)
                    inputs.push_back(sample == 0 ? bound.low : sample == 1 ? bound.high : draw(bound.low, bound.high));
                const double value = expression::value_of<double>(formula, inputs);
                if (std::isnan(value)) {
                    CAPTURE(text, inputs[0], found.low, found.high);
                    REQUIRE(found.has_gaps);
                    continue;
                }
                CAPTURE(text, bounds[0].low, bounds[0].high, value, found.low, found.high);
                REQUIRE(found.low <= value);
                REQUIRE(value <= found.high);
                ++checked;
            }
        }
    }
    CHECK(checked > 60000);
}

TEST_CASE("ranges of narrow operands are narrow, and those of which nothing is known are infinite") {
    const Range x(0.7, 0.7 + 1e-9), y(-1.3, -1.3 + 1e-9);
    for (const Range& found : {x * y, x / y, sin(x), cos(y), tan(x), asin(x), acos(x), atan(y), exp(y), log(x), pow(x, y), pow(y, 3.0),
                               atan2(x, y), atan2(y, x), hypot(x, y), sqrt(x)})
        CHECK(found.high - found.low < 1e-8);
    CHECK(std::isinf((x / Range(-1e-12, 1)).low));
    CHECK(std::isinf((x / 0.0).high));
    CHECK(std::isinf(log(y).low));
    CHECK(std::isinf(log(Range(0.0, 1.0)).low));
    CHECK(log(Range(0.0, 1.0)).high < 1e-15);
    CHECK(std::isinf(sqrt(y).high));
    CHECK(std::isinf(pow(y, 0.5).low));
    CHECK(Range(NAN, NAN).low == -INFINITY);
    CHECK((Range(-INFINITY, INFINITY) * 0.0).high == INFINITY);
    CHECK(sin(Range(0, INFINITY)).high == 1);
}

TEST_CASE("marks say where an operation changes sides or is not defined, and pass on") {
    const Range x(-1, 2), positive(1, 2);
    for (const Range& found : {abs(x), minimum(x, 1.0), maximum(x, positive), choose(x, 1.0, 2.0)}) {
        CHECK(found.switches);
        CHECK((2.0 * found + 1.0).switches);
        CHECK_FALSE(found.has_gaps);
    }
    for (const Range& found :
         {abs(positive), minimum(positive, 3.0), choose(positive, 1.0, 2.0), atan2(x, positive), pow(x, 2.0), sqrt(positive)}) {
        CHECK_FALSE(found.switches);
        CHECK_FALSE(found.has_gaps);
    }
    for (const Range& found : {sqrt(x), log(x), asin(x), acos(x), pow(x, 0.5), pow(x, positive), sqrt(-positive), atan2(x, -positive)}) {
        CHECK(found.has_gaps);
        CHECK(sin(found).has_gaps);
    }
    CHECK(sqrt(x).low == 0);
    CHECK(minimum(x, positive).high == 2);
    CHECK(minimum(Range(-1, 0), positive).high == 0);
}

}  // namespace fettle::core::geometry::range_test
