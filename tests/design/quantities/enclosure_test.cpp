// SPDX-License-Identifier: MIT
// Enclosures contain what formulas give for any numbers of their operands, by sampling; where nothing is known they say so.
#include "fettle/design/quantities/enclosure.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "fettle/core/expression/parse_formula.hpp"

namespace fettle::design::quantities::enclosure_test {

namespace {

core::expression::Formula formula_of(const std::string& text) {
    core::expression::Scope scope;
    scope.names = {{"x", {}}, {"y", {}}};
    const auto formula = core::expression::parse_formula(text, scope);
    for (const Error& error : formula.errors()) UNSCOPED_INFO(text + ": " + error.message);
    REQUIRE(formula);
    return *formula;
}

}  // namespace

TEST_CASE("an enclosure contains the formula's value at every point of its operands") {
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
        const core::expression::Formula formula = formula_of(text);
        for (int run = 0; run < 400; ++run) {
            const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
            const double width = std::pow(10, draw(-16, 0.5));
            std::vector<Enclosure> bounds;
            for (std::size_t k = 0; k < formula.inputs.size(); ++k) {
                const double low = draw(-2, 2);
                bounds.emplace_back(low, low + width * draw(0, 1));
            }
            const Enclosure found = core::expression::value_of<Enclosure>(formula, bounds);
            REQUIRE(found.low <= found.high);
            for (int sample = 0; sample < 8; ++sample) {
                std::vector<double> inputs;
                for (const Enclosure& bound : bounds)
                    inputs.push_back(sample == 0 ? bound.low : sample == 1 ? bound.high : draw(bound.low, bound.high));
                const double value = core::expression::value_of<double>(formula, inputs);
                if (std::isnan(value)) continue;
                CAPTURE(text, bounds[0].low, bounds[0].high, value, found.low, found.high);
                REQUIRE(found.low <= value);
                REQUIRE(value <= found.high);
                ++checked;
            }
        }
    }
    CHECK(checked > 60000);
}

TEST_CASE("enclosures of narrow operands are narrow, and those of which nothing is known are infinite") {
    const Enclosure x(0.7, 0.7 + 1e-9), y(-1.3, -1.3 + 1e-9);
    for (const Enclosure& found : {x * y, x / y, sin(x), cos(y), tan(x), asin(x), acos(x), atan(y), exp(y), log(x), pow(x, y), pow(y, 3.0),
                                   atan2(x, y), atan2(y, x), hypot(x, y), sqrt(x)})
        CHECK(found.high - found.low < 1e-8);
    CHECK(std::isinf((x / Enclosure(-1e-12, 1)).low));
    CHECK(std::isinf((x / 0.0).high));
    CHECK(std::isinf(log(y).low));
    CHECK(std::isinf(log(Enclosure(0.0, 1.0)).low));
    CHECK(log(Enclosure(0.0, 1.0)).high < 1e-15);
    CHECK(std::isinf(sqrt(y).high));
    CHECK(std::isinf(pow(y, 0.5).low));
    CHECK(Enclosure(NAN, NAN).low == -INFINITY);
    CHECK((Enclosure(-INFINITY, INFINITY) * 0.0).high == INFINITY);
    CHECK(sin(Enclosure(0, INFINITY)).high == 1);
}

}  // namespace fettle::design::quantities::enclosure_test
