// SPDX-License-Identifier: MIT
#include "core/geometry/range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::core::geometry {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// These lie between two neighbours each.
const Interval quarter_turn{0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0}, half_turn{0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1};

// The range round numbers by the C library, which is trusted to 2 ulps.
Range around(double low, double high) { return {lower(lower(low)), upper(upper(high))}; }

Range clamped(const Range& a, double low, double high) {
    return Range(std::clamp(a.low, low, high), std::clamp(a.high, low, high)).marked_as(a);
}

Range with_gaps(Range a) {
    a.has_gaps = true;
    return a;
}

// The range of a function that rises on all of `a`.
template <class Function>
Range rising(const Range& a, Function f) {
    return around(f(a.low), f(a.high)).marked_as(a);
}

struct Extremes {
    double least, most;
};

// The extremes of a function of two that has them at the corners; NaN where one of them has no value, which must not get lost among the
// others.
template <class Function>
Extremes at_corners(const Range& a, const Range& b, Function f) {
    const double corners[] = {f(a.low, b.low), f(a.low, b.high), f(a.high, b.low), f(a.high, b.high)};
    Extremes out{corners[0], corners[0]};
    for (const double x : corners) {
        if (std::isnan(x)) return {NAN, NAN};
        out = {std::min(out.least, x), std::max(out.most, x)};
    }
    return out;
}

// The power of a range that is not negative, with an exponent that is a number.
Range power_of_magnitude(const Range& a, double exponent) {
    const double at_low = std::pow(a.low, exponent), at_high = std::pow(a.high, exponent);
    const Range found = exponent < 0 ? around(at_high, at_low) : around(at_low, at_high);
    return Range(std::max(0.0, found.low), found.high).marked_as(a);
}

Range whole_power(const Range& a, double exponent) {
    if (exponent == 0) return Range(1.0).marked_as(a);
    if (std::fmod(exponent, 2) == 0) {
        // A square has no kink where its base changes sign.
        Range magnitude = abs(a);
        magnitude.switches = a.switches;
        return power_of_magnitude(magnitude, exponent);
    }
    if (a.low >= 0) return power_of_magnitude(a, exponent);
    if (a.high <= 0) return -power_of_magnitude(-a, exponent);
    if (exponent < 0) return Range::whole_line().marked_as(a);  // the pole is inside
    return rising(a, [exponent](double x) { return std::pow(x, exponent); });
}

}  // namespace

Range::Range(double l, double h) : low(std::isnan(l) ? -unbounded : l), high(std::isnan(h) ? unbounded : h) {}

Range Range::whole_line() { return {-unbounded, unbounded}; }

Range Range::marked_as(const Range& other) const {
    Range out = *this;
    out.switches |= other.switches;
    out.has_gaps |= other.has_gaps;
    return out;
}

Range hull(const Range& a, const Range& b) { return Range(std::min(a.low, b.low), std::max(a.high, b.high)).marked_as(a).marked_as(b); }

Range operator+(const Range& a, const Range& b) {
    const double sum = a.low + b.low;
    if (a.is_number() && b.is_number()) {
        // Knuth's sum with its error.
        const double part = sum - a.low;
        if ((a.low - (sum - part)) + (b.low - part) == 0) return Range(sum).marked_as(a).marked_as(b);
    }
    return Range(lower(sum), upper(a.high + b.high)).marked_as(a).marked_as(b);
}

Range operator*(const Range& a, const Range& b) {
    const auto [least, most] = at_corners(a, b, [](double x, double y) { return x * y; });
    return Range(lower(least), upper(most)).marked_as(a).marked_as(b);
}

Range operator/(const Range& a, const Range& b) {
    if (b.contains(0)) return Range::whole_line().marked_as(a).marked_as(b);
    const auto [least, most] = at_corners(a, b, [](double x, double y) { return x / y; });
    return Range(lower(least), upper(most)).marked_as(a).marked_as(b);
}

Range sqrt(const Range& a) {
    if (a.high < 0) return with_gaps(Range::whole_line().marked_as(a));
    const Range root(std::max(0.0, lower(std::sqrt(std::max(0.0, a.low)))), upper(std::sqrt(a.high)));
    return a.low < 0 ? with_gaps(root.marked_as(a)) : root.marked_as(a);
}

Range hypot(const Range& a, const Range& b) {
    const Range sum(square(a.interval()) + square(b.interval()));
    return sqrt(Range(std::max(0.0, sum.low), sum.high)).marked_as(a).marked_as(b);
}

Range sin(const Range& a) {
    if (!a.is_bounded() || a.magnitude() > 1e6) return Range(-1.0, 1.0).marked_as(a);
    return Range(geometry::sin(a.interval())).marked_as(a);
}

Range cos(const Range& a) {
    if (!a.is_bounded() || a.magnitude() > 1e6) return Range(-1.0, 1.0).marked_as(a);
    return Range(geometry::sin(a.interval() + quarter_turn)).marked_as(a);
}

Range tan(const Range& a) {
    if (cos(a).contains(0)) return Range::whole_line().marked_as(a);
    return rising(a, [](double x) { return std::tan(x); });
}

Range asin(const Range& a) {
    if (a.high < -1 || a.low > 1) return with_gaps(Range::whole_line().marked_as(a));
    const Range found = rising(clamped(a, -1, 1), [](double x) { return std::asin(x); });
    return a.low < -1 || a.high > 1 ? with_gaps(found) : found;
}

Range acos(const Range& a) {
    if (a.high < -1 || a.low > 1) return with_gaps(Range::whole_line().marked_as(a));
    const Range found = -rising(clamped(a, -1, 1), [](double x) { return -std::acos(x); });
    return a.low < -1 || a.high > 1 ? with_gaps(found) : found;
}

Range atan(const Range& a) {
    return rising(a, [](double x) { return std::atan(x); });
}

Range exp(const Range& a) {
    const Range found = rising(a, [](double x) { return std::exp(x); });
    return Range(std::max(0.0, found.low), found.high).marked_as(a);
}

Range log(const Range& a) {
    if (a.high <= 0) return with_gaps(Range::whole_line().marked_as(a));
    const double at_low = a.low <= 0 ? -unbounded : std::log(a.low);
    const Range found = around(at_low, std::log(a.high)).marked_as(a);
    return a.low < 0 ? with_gaps(found) : found;
}

Range pow(const Range& a, const Range& b) {
    if (b.is_number() && b.is_bounded()) {
        if (b.low == std::floor(b.low)) return whole_power(a, b.low).marked_as(b);
        if (a.high < 0) return with_gaps(Range::whole_line().marked_as(a).marked_as(b));
        const Range found = power_of_magnitude(clamped(a, 0, unbounded), b.low).marked_as(b);
        return a.low < 0 ? with_gaps(found) : found;
    }
    if (!(a.low > 0)) return with_gaps(Range::whole_line().marked_as(a).marked_as(b));
    const auto [least, most] = at_corners(a, b, [](double x, double n) { return std::pow(x, n); });
    const Range found = around(least, most);
    return Range(std::max(0.0, found.low), found.high).marked_as(a).marked_as(b);
}

Range atan2(const Range& y, const Range& x) {
    // Off the half line where it jumps, a box has its extreme angles at its corners.
    if (x.low > 0 || y.low > 0 || y.high < 0) {
        const auto [least, most] = at_corners(y, x, [](double a, double b) { return std::atan2(a, b); });
        return around(least, most).marked_as(y).marked_as(x);
    }
    return with_gaps(Range(-half_turn.high, half_turn.high).marked_as(y).marked_as(x));
}

Range abs(const Range& a) {
    if (a.low >= 0) return a;
    if (a.high <= 0) return -a;
    Range out = Range(0, a.magnitude()).marked_as(a);
    out.switches = true;
    return out;
}

Range minimum(const Range& a, const Range& b) {
    Range out = Range(std::min(a.low, b.low), std::min(a.high, b.high)).marked_as(a).marked_as(b);
    out.switches |= a.low <= b.high && b.low <= a.high;
    return out;
}

Range maximum(const Range& a, const Range& b) { return -minimum(-a, -b); }

Range choose(const Range& a, const Range& b, const Range& c) {
    if (!a.has_gaps) {
        if (a.high < 0) return b;
        if (a.low >= 0) return c;
    }
    Range out = hull(b, c);
    out.switches = true;
    out.has_gaps |= a.has_gaps;
    return out;
}

}  // namespace fettle::core::geometry
