// SPDX-License-Identifier: MIT
#include "core/base/rounded_lengths.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace fettle::core::base::rounded_lengths_test {

TEST_CASE("A bound that is printed is still a bound, in every unit") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> exponent(-12, 3);
    for (const auto& [unit, metres] :
         {std::pair{"um", 1e-6L}, {"mm", 1e-3L}, {"cm", 1e-2L}, {"m", 1.0L}, {"in", 0.0254L}, {"ft", 0.3048L}}) {
        for (const int decimals : {0, 3, 9}) {
            const RoundedLengths lengths(unit, decimals);
            for (int i = 0; i < 2000; ++i) {
                const double x = std::pow(10, exponent(random));
                for (const bool table : {true, false}) {
                    const std::string low = table ? lengths.fixed(x, Towards::down) : lengths.shortest(x, Towards::down);
                    const std::string high = table ? lengths.fixed(x, Towards::up) : lengths.shortest(x, Towards::up);
                    CAPTURE(unit, decimals, x, low, high);
                    const long double l = std::strtold(low.c_str(), nullptr) * metres, h = std::strtold(high.c_str(), nullptr) * metres;
                    if (!(static_cast<double>(l) <= x && static_cast<double>(h) >= x)) FAIL_CHECK("not a bound");
                    const double coarse = std::max(0.011 * x, 1.1 * static_cast<double>(metres) * std::pow(10, -decimals));
                    if (!(l >= x - coarse && h <= x + coarse)) FAIL_CHECK("far from the bound");
                    if (!table && !(l >= x * (1 - 1e-15) && h <= x * (1 + 1e-15))) FAIL_CHECK("the shortest is close");
                }
            }
        }
    }
    const RoundedLengths millimetres("mm", 3);
    CHECK(millimetres.fixed(0.0005, Towards::down) == "0.500");
    CHECK(millimetres.fixed(0.0005, Towards::up) == "0.500");
    CHECK(millimetres.fixed(0, Towards::down) == "0");
}

}  // namespace fettle::core::base::rounded_lengths_test
