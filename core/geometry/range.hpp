// SPDX-License-Identifier: MIT
/// What an expression can be when its operands are known within bounds alone: an interval that contains the result for all numbers of the
/// operands, rounding included (interval.hpp). Unlike an Interval it has every operation of formulas (expression/operation.hpp), and no
/// contract: where nothing is known on a side (a quotient by 0, the logarithm of 0) the bound there is infinite.
///
/// Two marks go with it, and pass on to all that is computed from it:
///  - `switches`: among the operands' numbers is a place at which abs, minimum, maximum or choose changes sides;
///  - `has_gaps`: for some of them an operation is not defined (the root of a negative number; the interval is that of the others), or it
///    jumps there by itself (atan2).
#pragma once

#include "core/geometry/interval.hpp"

namespace fettle::core::geometry {

struct Range {
    double low = 0, high = 0;  ///< low <= high; never NaN
    bool switches = false, has_gaps = false;

    Range() = default;
    Range(double exact) : Range(exact, exact) {}  // NOLINT: a number is a range
    /// A bound that is NaN is infinite: nothing is known on that side.
    Range(double l, double h);
    explicit Range(const Interval& i) : Range(i.low, i.high) {}
    static Range whole_line();

    /// This one, with another's marks as well.
    Range marked_as(const Range& other) const;

    Interval interval() const { return {low, high}; }
    bool is_number() const { return low == high; }
    bool is_bounded() const { return std::isfinite(low) && std::isfinite(high); }
    bool contains(double x) const { return low <= x && x <= high; }
    /// Largest |x| in it.
    double magnitude() const { return std::max(-low, high); }
};

Range hull(const Range& a, const Range& b);

/// The same numbers, whatever their marks.
inline bool operator==(const Range& a, const Range& b) { return a.low == b.low && a.high == b.high; }

inline Range operator+(const Range& a) { return a; }
inline Range operator-(const Range& a) { return Range(-a.high, -a.low).marked_as(a); }
/// Sums of numbers without rounding stay numbers, as exponents are.
Range operator+(const Range& a, const Range& b);
inline Range operator-(const Range& a, const Range& b) { return a + -b; }
Range operator*(const Range& a, const Range& b);
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
Range abs(const Range& a);
Range minimum(const Range& a, const Range& b);
Range maximum(const Range& a, const Range& b);

}  // namespace fettle::core::geometry
