// SPDX-License-Identifier: MIT
/// Interval arithmetic in doubles: every operation returns an interval that contains the exact result for all arguments in its operands.
///
/// Rounding is outward without switching the processor's rounding mode (which costs more than the arithmetic). With rounding to
/// nearest the exact result lies within half an ulp of the computed one, x, and lower(x) = x - (|x| 2^-52 + 2^-1074) is at most the
/// next double below x: |x| 2^-52 is at least one ulp of a normal x, and the last term steps down a subnormal one. So bounds are at most
/// two ulps wider per operation than the best. Elementary functions of the C library are trusted to 2 ulps (glibc 2.36 documents at
/// most 1) and widened by as much. Infinite bounds are allowed, NaN is not.
/// By hand: libraries of intervals (Boost's, MPFI) switch the rounding mode or compute in long numbers, many times as slow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

/// A double at most the one before / at least the one after x.
inline double lower(double x) { return x - (std::abs(x) * 0x1p-52 + 0x1p-1074); }
inline double upper(double x) { return x + (std::abs(x) * 0x1p-52 + 0x1p-1074); }

/// [low, high], low <= high.
struct Interval {
    double low = 0, high = 0;

    Interval() = default;
    Interval(double exact) : low(exact), high(exact) {}  // NOLINT: a double is an interval
    Interval(double l, double h) : low(l), high(h) {}

    bool contains(double x) const { return low <= x && x <= high; }
    double width() const { return upper(high - low); }
    /// Largest |x| in the interval, exact.
    double magnitude() const { return std::max(-low, high); }
};

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) { return {lower(a.low + b.low), upper(a.high + b.high)}; }
inline Interval operator-(const Interval& a, const Interval& b) { return {lower(a.low - b.high), upper(a.high - b.low)}; }
inline Interval operator*(const Interval& a, const Interval& b) {
    const double ll = a.low * b.low, lh = a.low * b.high, hl = a.high * b.low, hh = a.high * b.high;
    return {lower(std::min({ll, lh, hl, hh})), upper(std::max({ll, lh, hl, hh}))};
}

/// Contract: 0 is not in b.
Interval operator/(const Interval& a, const Interval& b);

/// x^2, never below 0.
inline Interval square(const Interval& a) {
    const double m = a.magnitude();
    const double least = a.low > 0 ? a.low : (a.high < 0 ? a.high : 0);
    return {std::max(0.0, lower(least * least)), upper(m * m)};
}

/// Square root of the part of the interval that is not negative. Contract: high >= 0.
Interval sqrt(const Interval& a);

inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

/// Contract of sin: finite.
Interval sin(const Interval& a);

/// sin(x)/x: even, and falling on [0, 4.4934094579], where end points give the range; the plain quotient beyond. Source: Ferguson et al.
/// 2021, Intersection-free Rigid Body Dynamics, Appendix A.3.
Interval sinc(const Interval& a);

using Interval3 = std::array<Interval, 3>;

Interval3 cross(const Interval3& a, const Interval3& b);

/// Upper bound of the norm.
double norm_bound(const Interval3& a);

}  // namespace fettle::core::geometry
