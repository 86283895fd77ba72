// SPDX-License-Identifier: MIT
#include "core/geometry/interval.hpp"

#include "core/base/contract.hpp"

namespace fettle::core::geometry {

namespace {

constexpr double pi = 3.14159265358979323846;
/// Below the first positive minimum of sinc, 4.49340945790906...
constexpr double sinc_falls_until = 4.4934094579;

/// For functions of the C library: twice the step of lower() and upper().
double lower_twice(double x) { return lower(lower(x)); }
double upper_twice(double x) { return upper(upper(x)); }

/// Might one of the points phase + 2 pi k lie in [low, high]? Never a wrong no: the slack covers the rounding of the division by 2 pi.
bool may_contain_phase(double low, double high, double phase) {
    const double slack = 1e-15 * (2 + std::abs(low) + std::abs(high));
    return std::floor((high - phase) / (2 * pi) + slack) > std::floor((low - phase) / (2 * pi) - slack);
}

/// sinc at a point x >= 0.
Interval sinc_at(double x) {
    if (x == 0) return 1.0;
    const double value = std::sin(x) / x;
    return {lower_twice(value), std::min(1.0, upper_twice(value))};
}

}  // namespace

Interval operator/(const Interval& a, const Interval& b) {
    FETTLE_ASSERT(b.low > 0 || b.high < 0, "division by an interval that contains 0");
    const double ll = a.low / b.low, lh = a.low / b.high, hl = a.high / b.low, hh = a.high / b.high;
    return {lower(std::min({ll, lh, hl, hh})), upper(std::max({ll, lh, hl, hh}))};
}

Interval sqrt(const Interval& a) {
    FETTLE_ASSERT(a.high >= 0, "square root of a negative interval");
    return {a.low > 0 ? std::max(0.0, lower(std::sqrt(a.low))) : 0.0, upper(std::sqrt(a.high))};
}

Interval sin(const Interval& a) {
    const double at_low = std::sin(a.low), at_high = std::sin(a.high);
    Interval r{std::max(-1.0, lower_twice(std::min(at_low, at_high))), std::min(1.0, upper_twice(std::max(at_low, at_high)))};
    if (may_contain_phase(a.low, a.high, 0.5 * pi)) r.high = 1;
    if (may_contain_phase(a.low, a.high, -0.5 * pi)) r.low = -1;
    return r;
}

Interval sinc(const Interval& a) {
    const double high = a.magnitude();
    const double low = a.low > 0 ? a.low : (a.high < 0 ? -a.high : 0);
    if (high <= sinc_falls_until) return {sinc_at(high).low, sinc_at(low).high};
    if (low >= sinc_falls_until) return sin(Interval(low, high)) / Interval(low, high);
    const Interval falling{sinc_at(sinc_falls_until).low, sinc_at(low).high};
    const Interval beyond{sinc_falls_until, high};
    return hull(falling, sin(beyond) / beyond);
}

Interval3 cross(const Interval3& a, const Interval3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double norm_bound(const Interval3& a) {
    const Interval sum = square(a[0]) + square(a[1]) + square(a[2]);
    return upper(std::sqrt(sum.high));
}

}  // namespace fettle::core::geometry
