// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fettle/core/geometry/interval.hpp"

namespace fettle::design::quantities {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// Functions of the C library are trusted to 2 ulps, as in core/geometry/interval.hpp; pow, whose error glibc states as 1, too.
double below(double x) { return core::geometry::lower(core::geometry::lower(core::geometry::lower(x))); }
double above(double x) { return core::geometry::upper(core::geometry::upper(core::geometry::upper(x))); }

Enclosure everything() { return {-unbounded, unbounded}; }
Enclosure hull(const Enclosure& a, const Enclosure& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
Enclosure within(const Enclosure& a, double low, double high) { return {std::clamp(a.low, low, high), std::clamp(a.high, low, high)}; }

template <class Function>
Enclosure rising(const Enclosure& a, Function f) {
    return {below(f(a.low)), above(f(a.high))};
}

// The function's slope is at most 1, so it is as wide as its argument at most.
template <class Function>
Enclosure of_wave(const Enclosure& a, Function f) {
    if (!std::isfinite(a.low) || !std::isfinite(a.high)) return {-1, 1};
    const double middle = a.low + (a.high - a.low) / 2, reach = above(std::max(a.high - middle, middle - a.low));
    const double value = f(middle);
    return {std::max(-1.0, below(below(value) - reach)), std::min(1.0, above(above(value) + reach))};
}

// Of a number that is not negative, to a fixed power.
Enclosure power_of_magnitude(const Enclosure& a, double exponent) {
    const Enclosure rises{std::max(0.0, below(std::pow(a.low, exponent))), above(std::pow(a.high, exponent))};
    const Enclosure falls{std::max(0.0, below(std::pow(a.high, exponent))), above(std::pow(a.low, exponent))};
    return exponent < 0 ? falls : rises;
}

Enclosure whole_power(const Enclosure& a, double exponent) {
    const bool even = std::fmod(exponent, 2) == 0;
    if (even) return power_of_magnitude(abs(a), exponent);
    if (a.low >= 0) return power_of_magnitude(a, exponent);
    if (a.high <= 0) return -power_of_magnitude(-a, exponent);
    if (exponent < 0) return everything();  // the pole is inside
    return {-power_of_magnitude(Enclosure(0, -a.low), exponent).high, power_of_magnitude(Enclosure(0, a.high), exponent).high};
}

}  // namespace

Enclosure::Enclosure(double exact) : Enclosure(exact, exact) {}
Enclosure::Enclosure(double l, double h) : low(std::isnan(l) ? -unbounded : l), high(std::isnan(h) ? unbounded : h) {}

Enclosure operator-(const Enclosure& a) { return {-a.high, -a.low}; }
Enclosure operator+(const Enclosure& a, const Enclosure& b) { return {below(a.low + b.low), above(a.high + b.high)}; }
Enclosure operator-(const Enclosure& a, const Enclosure& b) { return {below(a.low - b.high), above(a.high - b.low)}; }

Enclosure operator*(const Enclosure& a, const Enclosure& b) {
    const double corners[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    if (std::any_of(std::begin(corners), std::end(corners), [](double x) { return std::isnan(x); })) return everything();
    const auto [least, most] = std::minmax_element(std::begin(corners), std::end(corners));
    return {below(*least), above(*most)};
}

Enclosure operator/(const Enclosure& a, const Enclosure& b) {
    if (b.low <= 0 && b.high >= 0) return everything();
    return a * Enclosure(below(1 / b.high), above(1 / b.low));
}

Enclosure sqrt(const Enclosure& a) {
    if (a.high < 0) return everything();
    const double low = std::sqrt(std::max(0.0, a.low));
    return {std::max(0.0, below(low)), above(std::sqrt(a.high))};
}

Enclosure abs(const Enclosure& a) {
    if (a.low >= 0) return a;
    if (a.high <= 0) return -a;
    return {0, std::max(-a.low, a.high)};
}

Enclosure sin(const Enclosure& a) {
    return of_wave(a, [](double x) { return std::sin(x); });
}
Enclosure cos(const Enclosure& a) {
    return of_wave(a, [](double x) { return std::cos(x); });
}
Enclosure tan(const Enclosure& a) { return sin(a) / cos(a); }

Enclosure asin(const Enclosure& a) {
    if (a.high < -1 || a.low > 1) return everything();
    return rising(within(a, -1, 1), [](double x) { return std::asin(x); });
}

Enclosure acos(const Enclosure& a) {
    if (a.high < -1 || a.low > 1) return everything();
    return -rising(within(a, -1, 1), [](double x) { return -std::acos(x); });
}

Enclosure atan(const Enclosure& a) {
    return rising(a, [](double x) { return std::atan(x); });
}

Enclosure exp(const Enclosure& a) {
    const Enclosure found = rising(a, [](double x) { return std::exp(x); });
    return {std::max(0.0, found.low), found.high};
}

Enclosure log(const Enclosure& a) {
    if (a.high <= 0) return everything();
    return {a.low <= 0 ? -unbounded : below(std::log(a.low)), above(std::log(a.high))};
}

Enclosure pow(const Enclosure& a, const Enclosure& b) {
    const bool fixed = b.low == b.high && std::isfinite(b.low);
    if (fixed && b.low == std::floor(b.low)) return whole_power(a, b.low);
    if (fixed && a.low >= 0) return power_of_magnitude(a, b.low);
    return a.low > 0 ? exp(b * log(a)) : everything();
}

Enclosure atan2(const Enclosure& y, const Enclosure& x) {
    if (x.low > 0) return atan(y / x);
    const double half_turn = std::atan2(0.0, -1.0);
    if (y.low > 0) return Enclosure(below(half_turn / 2), above(half_turn / 2)) - atan(x / y);
    return {-above(half_turn), above(half_turn)};
}

Enclosure hypot(const Enclosure& a, const Enclosure& b) { return sqrt(whole_power(a, 2) + whole_power(b, 2)); }

Enclosure minimum(const Enclosure& a, const Enclosure& b) { return {std::min(a.low, b.low), std::min(a.high, b.high)}; }
Enclosure maximum(const Enclosure& a, const Enclosure& b) { return {std::max(a.low, b.low), std::max(a.high, b.high)}; }

Enclosure choose(const Enclosure& a, const Enclosure& b, const Enclosure& c) {
    if (a.high < 0) return b;
    return a.low >= 0 ? c : hull(b, c);
}

}  // namespace fettle::design::quantities
