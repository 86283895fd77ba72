// SPDX-License-Identifier: MIT
/// What an expression can be when its operands are known within bounds alone: an interval that contains the result for all numbers of the
/// operands, rounding included. Unlike core/geometry/interval.hpp it has every operation of formulas (core/expression/operation.hpp), and
/// no contract: where nothing is known (a quotient by 0, the logarithm of a negative number) a bound is infinite.
#pragma once

namespace fettle::design::quantities {

struct Enclosure {
    double low = 0, high = 0;  ///< low <= high; never NaN

    Enclosure(double exact);  // NOLINT: numbers mix with enclosures
    /// A bound that is NaN is infinite: nothing is known on that side.
    Enclosure(double l, double h);
};

Enclosure operator-(const Enclosure& a);
Enclosure operator+(const Enclosure& a, const Enclosure& b);
Enclosure operator-(const Enclosure& a, const Enclosure& b);
Enclosure operator*(const Enclosure& a, const Enclosure& b);
Enclosure operator/(const Enclosure& a, const Enclosure& b);

Enclosure sqrt(const Enclosure& a);
Enclosure abs(const Enclosure& a);
Enclosure sin(const Enclosure& a);
Enclosure cos(const Enclosure& a);
Enclosure tan(const Enclosure& a);
Enclosure asin(const Enclosure& a);
Enclosure acos(const Enclosure& a);
Enclosure atan(const Enclosure& a);
Enclosure exp(const Enclosure& a);
Enclosure log(const Enclosure& a);
Enclosure pow(const Enclosure& a, const Enclosure& b);
Enclosure atan2(const Enclosure& y, const Enclosure& x);
Enclosure hypot(const Enclosure& a, const Enclosure& b);
Enclosure minimum(const Enclosure& a, const Enclosure& b);
Enclosure maximum(const Enclosure& a, const Enclosure& b);
Enclosure choose(const Enclosure& a, const Enclosure& b, const Enclosure& c);

}  // namespace fettle::design::quantities
