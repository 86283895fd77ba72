// SPDX-License-Identifier: MIT
#include "core/parts/point.hpp"

#include <cmath>
#include <numbers>

namespace fettle::core::parts {
namespace {

// The point at the fraction k / n of a turn, by the first eighth, so that points mirrored in the diagonal have the same two numbers.
Vector2 first_quarter(int k, int n) {
    const double step = 2 * std::numbers::pi / n;
    if (8 * k == n) return {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2};
    if (8 * k < n) return {std::cos(step * k), std::sin(step * k)};
    const double rest = step * (n / 4.0 - k);
    return {std::sin(rest), std::cos(rest)};
}

}  // namespace

Point2 direction(int k, int n) {
    k = ((k % n) + n) % n;
    if (n % 4 != 0) return {std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n)};
    const int quarter = n / 4;
    const Vector2 d = first_quarter(k % quarter, n);
    switch (k / quarter) {
        case 0:
            return {d.x(), d.y()};
        case 1:
            return {-d.y(), d.x()};
        case 2:
            return {-d.x(), -d.y()};
        default:
            return {d.y(), -d.x()};
    }
}

Point2 direction(const Number& angle) {
    if (!angle.is_constant()) return {cos(angle), sin(angle)};
    const double quarters = angle.value / (std::numbers::pi / 2), whole = std::round(quarters);
    if (std::abs(quarters - whole) <= 4e-16 * std::abs(whole) && std::abs(whole) < 1e6) return direction(static_cast<int>(whole), 4);
    return {std::cos(angle.value), std::sin(angle.value)};
}

Point2 polar(const Number& radius, const Number& angle) { return radius * direction(angle); }

}  // namespace fettle::core::parts
