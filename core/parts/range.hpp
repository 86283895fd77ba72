// SPDX-License-Identifier: MIT
/// What a law's numbers are over a stretch of its parameter: an interval that contains the value for every parameter of the stretch,
/// rounding included (geometry/interval.hpp). All operations of expression/operation.hpp, and every one has an answer: where one is not
/// defined on all of its operands (a quotient by 0, a root of a negative number) that is the whole line.
///
/// Where the stretch contains a place at which `choose`, abs, minimum or maximum changes sides, the range holds both sides and `switches`;
/// so does all that is computed from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fettle/core/geometry/interval.hpp"

namespace fettle::core::parts {

struct Range {
    geometry::Interval interval;
    bool switches = false;

    Range() = default;
    Range(double exact) : Range(geometry::Interval(exact), false) {}  // NOLINT: a number is a range; NaN: the whole line
    Range(double low, double high) : interval(low, high) {}
    Range(const geometry::Interval& i, bool s) : interval(i), switches(s) {
        if (!is_bounded()) interval = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    static Range whole_line(bool s) { return {{NAN, NAN}, s}; }

    double low() const { return interval.low; }
    double high() const { return interval.high; }
    bool is_number() const { return interval.low == interval.high; }
    bool is_bounded() const { return std::isfinite(interval.low) && std::isfinite(interval.high); }
    /// Largest |x| in it.
    double magnitude() const { return interval.magnitude(); }
};

Range hull(const Range& a, const Range& b);

inline bool operator==(const Range& a, const Range& b) { return a.low() == a.high() && a.low() == b.low() && a.high() == b.high(); }

inline Range operator+(const Range& a) { return a; }
inline Range operator-(const Range& a) { return {-a.interval, a.switches}; }
inline Range operator+(const Range& a, const Range& b) {
    const bool switches = a.switches || b.switches;
    if (!(a.is_bounded() && b.is_bounded())) return Range::whole_line(switches);
    if (a.is_number() && b.is_number()) {
        // Sums of small whole numbers stay numbers, as exponents are. Knuth's sum with its error.
        const double sum = a.low() + b.low(), part = sum - a.low();
        if ((a.low() - (sum - part)) + (b.low() - part) == 0) return {geometry::Interval(sum), switches};
    }
    return {a.interval + b.interval, switches};
}
inline Range operator-(const Range& a, const Range& b) { return a + -b; }
inline Range operator*(const Range& a, const Range& b) {
    const bool switches = a.switches || b.switches;
    return a.is_bounded() && b.is_bounded() ? Range(a.interval * b.interval, switches) : Range::whole_line(switches);
}
Range operator/(const Range& a, const Range& b);
Range sqrt(const Range& a);
Range hypot(const Range& a, const Range& b);
Range sin(const Range& a);
Range cos(const Range& a);
Range tan(const Range& a);
Range asin(const Range& a);
Range acos(const Range& a);
Range atan(const Range& a);
Range exp(const Range& a);
Range log(const Range& a);
Range pow(const Range& a, const Range& b);
Range atan2(const Range& y, const Range& x);
Range choose(const Range& a, const Range& b, const Range& c);

}  // namespace fettle::core::parts
