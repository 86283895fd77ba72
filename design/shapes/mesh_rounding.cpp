// SPDX-License-Identifier: MIT
#include "design/shapes/mesh_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace fettle::design::shapes {

namespace {

constexpr double float_rounding = 0x1p-24;
constexpr double unit_rounding = 1e-15;  // what dividing by the file's unit leaves open

// Is the number one of so many digits, to that share of itself?
bool has_digits(double number, int digits, double share) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, number);
    return std::abs(std::strtod(text, nullptr) - number) <= share * std::abs(number);
}

bool is_float(double number) {
    return std::abs(static_cast<double>(static_cast<float>(number)) - number) <= unit_rounding * std::abs(number);
}

}  // namespace

double coordinate_rounding(const Matrix3X& vertices, double unit) {
    const double largest = vertices.size() > 0 ? vertices.cwiseAbs().maxCoeff() / unit : 0;
    if (!(largest > 0)) return 0;
    const auto all = [&](auto&& holds) {
        const auto x = vertices.reshaped();
        return std::all_of(x.begin(), x.end(), [&](double value) { return holds(value / unit); });
    };
    const bool floats = all(is_float);
    const double kept = floats ? float_rounding : unit_rounding;
    for (int digits = 6; digits <= (floats ? 7 : 15); ++digits) {
        if (!all([&](double number) { return has_digits(number, digits, 2 * kept); })) continue;
        const double last_digit = std::pow(10, std::floor(std::log10(largest)) - digits + 1);
        return (0.5 * last_digit + kept * largest) * unit;
    }
    return kept * largest * unit;
}

}  // namespace fettle::design::shapes
