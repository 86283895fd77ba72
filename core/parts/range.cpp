// SPDX-License-Identifier: MIT
#include "fettle/core/parts/range.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::core::parts {
namespace {

using geometry::Interval;
using geometry::lower;
using geometry::upper;

// The quarter of a turn lies between these two neighbours.
const Interval quarter_turn{0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0};

Range whole(bool switches) { return Range::whole_line(switches); }

// Of numbers by the C library, which is trusted to 2 ulps.
Range around(double low, double high, bool switches) {
    if (!(std::isfinite(low) && std::isfinite(high))) return whole(switches);
    return {Interval(lower(lower(low)), upper(upper(high))), switches};
}

bool both_bounded(const Range& a, const Range& b) { return a.is_bounded() && b.is_bounded(); }
bool contains_zero(const Range& a) { return a.low() <= 0 && a.high() >= 0; }

// Of a function that rises (or falls) on all of the range.
template <class Function>
Range rising(const Range& a, Function f) {
    return around(f(a.low()), f(a.high()), a.switches);
}

// The extremes of a function of two are at the corners.
template <class Function>
Range at_corners(const Range& a, const Range& b, Function f) {
    const double ll = f(a.low(), b.low()), lh = f(a.low(), b.high()), hl = f(a.high(), b.low()), hh = f(a.high(), b.high());
    const bool switches = a.switches || b.switches;
    // NaN must not get lost among the others.
    if (!(std::isfinite(ll) && std::isfinite(lh) && std::isfinite(hl) && std::isfinite(hh))) return whole(switches);
    return around(std::min({ll, lh, hl, hh}), std::max({ll, lh, hl, hh}), switches);
}

}  // namespace

Range hull(const Range& a, const Range& b) { return {geometry::hull(a.interval, b.interval), a.switches || b.switches}; }

Range operator/(const Range& a, const Range& b) {
    const bool switches = a.switches || b.switches;
    return both_bounded(a, b) && !contains_zero(b) ? Range(a.interval / b.interval, switches) : whole(switches);
}

Range sqrt(const Range& a) { return a.is_bounded() && a.low() >= 0 ? Range(geometry::sqrt(a.interval), a.switches) : whole(a.switches); }

Range hypot(const Range& a, const Range& b) {
    const bool switches = a.switches || b.switches;
    return both_bounded(a, b) ? sqrt(Range(geometry::square(a.interval) + geometry::square(b.interval), switches)) : whole(switches);
}

Range sin(const Range& a) {
    if (!a.is_bounded() || a.magnitude() > 1e6) return {Interval(-1, 1), a.switches};
    return {geometry::sin(a.interval), a.switches};
}

Range cos(const Range& a) {
    if (!a.is_bounded() || a.magnitude() > 1e6) return {Interval(-1, 1), a.switches};
    return {geometry::sin(a.interval + quarter_turn), a.switches};
}

Range tan(const Range& a) {
    if (contains_zero(cos(a))) return whole(a.switches);
    return rising(a, [](double x) { return std::tan(x); });
}

Range asin(const Range& a) {
    if (!(a.low() >= -1 && a.high() <= 1)) return whole(a.switches);
    return rising(a, [](double x) { return std::asin(x); });
}

Range acos(const Range& a) {
    if (!(a.low() >= -1 && a.high() <= 1)) return whole(a.switches);
    return around(std::acos(a.high()), std::acos(a.low()), a.switches);
}

Range atan(const Range& a) {
    return rising(a, [](double x) { return std::atan(x); });
}

Range exp(const Range& a) {
    if (!a.is_bounded()) return whole(a.switches);
    return rising(a, [](double x) { return std::exp(x); });
}

Range log(const Range& a) {
    if (!(a.low() > 0)) return whole(a.switches);
    return rising(a, [](double x) { return std::log(x); });
}

Range pow(const Range& a, const Range& b) {
    const bool switches = a.switches || b.switches;
    if (!both_bounded(a, b)) return whole(switches);
    const auto power = [](double x, double n) { return std::pow(x, n); };
    if (a.low() > 0) return at_corners(a, b, power);
    const double n = b.low();
    if (!b.is_number()) return whole(switches);
    if (n == 0) return {Interval(1), switches};
    if (std::round(n) != n || std::abs(n) > 1e9) {
        // A base of 0 has roots, too; a negative one has none.
        return a.low() == 0 && n > 0 ? Range(Interval(0, around(0, power(a.high(), n), false).high()), switches) : whole(switches);
    }
    if (n < 0 && contains_zero(a)) return whole(switches);
    const bool is_even = std::fmod(n, 2) == 0;
    const double at_low = power(a.low(), n), at_high = power(a.high(), n);
    Range out = around(std::min(at_low, at_high), std::max(at_low, at_high), switches);
    if (is_even && contains_zero(a) && out.is_bounded()) out.interval.low = 0;
    return out;
}

Range atan2(const Range& y, const Range& x) {
    // Off the half line where it jumps, a box has its extreme angles at its corners.
    if (!(x.low() > 0 || y.low() > 0 || y.high() < 0)) return whole(x.switches || y.switches);
    return at_corners(y, x, [](double a, double b) { return std::atan2(a, b); });
}

Range choose(const Range& a, const Range& b, const Range& c) {
    if (a.high() < 0) return b;
    if (a.low() >= 0) return c;
    Range out = hull(b, c);
    out.switches = true;
    return out;
}

}  // namespace fettle::core::parts
