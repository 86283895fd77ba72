// SPDX-License-Identifier: MIT
/// A value with its first and second derivative in the parameter of a curve: what a law (curve.hpp) is called with where its tangent and
/// bending are wanted. All operations of expression/operation.hpp; mixes with constants and with recorded numbers. Where a function has no
/// derivative (a root at 0) the derivatives are infinite or NaN.
#pragma once

#include <cmath>
#include <type_traits>

#include "core/expression/operation.hpp"
#include "core/expression/tape.hpp"

namespace fettle::core::parts {

/// @tparam T  Number: derivatives are recorded as well; double: at the present values of all dimensions; geometry::Range: all values
///            over a stretch of the parameter; a Jet: up to the fourth derivative.
template <class T>
struct Jet {
    T value = 0, first = 0, second = 0;

    Jet() = default;
    Jet(double constant) : value(constant) {}  // NOLINT: constants and dimensions mix with what depends on the parameter
    Jet(const expression::Number& dimension) : value(as_value(dimension)) {}  // NOLINT
    Jet(const T& v, const T& d, const T& dd) : value(v), first(d), second(dd) {}
    /// The parameter itself, at this value.
    static Jet parameter(const T& at) { return {at, T(1.0), T(0.0)}; }

    Jet& operator+=(const Jet& b) { return *this = *this + b; }
    Jet& operator-=(const Jet& b) { return *this = *this - b; }
    Jet& operator*=(const Jet& b) { return *this = *this * b; }
    Jet& operator/=(const Jet& b) { return *this = *this / b; }

    friend Jet operator+(const Jet& a) { return a; }
    friend Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second}; }
    friend Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.first + b.first, a.second + b.second}; }
    friend Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.first - b.first, a.second - b.second}; }
    friend Jet operator*(const Jet& a, const Jet& b) {
        return {a.value * b.value, a.first * b.value + a.value * b.first,
                a.second * b.value + 2.0 * (a.first * b.first) + a.value * b.second};
    }
    friend Jet operator/(const Jet& a, const Jet& b) {
        const T q = a.value / b.value, dq = (a.first - q * b.first) / b.value;
        return {q, dq, (a.second - 2.0 * (dq * b.first) - q * b.second) / b.value};
    }

    friend bool operator==(const Jet& a, const Jet& b) { return a.value == b.value && a.first == b.first && a.second == b.second; }
    friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
    friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
    friend bool operator<=(const Jet& a, const Jet& b) { return a.value <= b.value; }
    friend bool operator>=(const Jet& a, const Jet& b) { return a.value >= b.value; }

    friend Jet sqrt(const Jet& a) {
        using std::sqrt;
        const T root = sqrt(a.value), slope = 0.5 / root;
        return chained(a, root, slope, -slope / (2.0 * a.value));
    }
    friend Jet sin(const Jet& a) {
        using std::cos, std::sin;
        const T s = sin(a.value);
        return chained(a, s, cos(a.value), -s);
    }
    friend Jet cos(const Jet& a) {
        using std::cos, std::sin;
        const T c = cos(a.value);
        return chained(a, c, -sin(a.value), -c);
    }
    friend Jet tan(const Jet& a) {
        using std::tan;
        const T t = tan(a.value), slope = 1.0 + t * t;
        return chained(a, t, slope, 2.0 * (t * slope));
    }
    friend Jet asin(const Jet& a) {
        using std::asin, std::sqrt;
        const T slope = 1.0 / sqrt((1.0 - a.value) * (1.0 + a.value));
        return chained(a, asin(a.value), slope, a.value * slope * slope * slope);
    }
    friend Jet acos(const Jet& a) {
        using std::acos, std::sqrt;
        const T slope = -1.0 / sqrt((1.0 - a.value) * (1.0 + a.value));
        return chained(a, acos(a.value), slope, a.value * slope * slope * slope);
    }
    friend Jet atan(const Jet& a) {
        using std::atan;
        const T slope = 1.0 / (1.0 + a.value * a.value);
        return chained(a, atan(a.value), slope, -2.0 * (a.value * slope * slope));
    }
    friend Jet exp(const Jet& a) {
        using std::exp;
        const T e = exp(a.value);
        return chained(a, e, e, e);
    }
    friend Jet log(const Jet& a) {
        using std::log;
        const T slope = 1.0 / a.value;
        return chained(a, log(a.value), slope, -slope * slope);
    }
    friend Jet pow(const Jet& a, const Jet& b) {
        using std::pow;
        if (!(is_zero(b.first) && is_zero(b.second))) return exp(b * log(a));
        // An exponent of 0 or 1 has derivatives at a base of 0 too.
        const T &x = a.value, &n = b.value;
        const T slope = is_zero(n) ? T(0.0) : n * pow(x, n - 1.0);
        const T bend = is_zero(n) || is_zero(n - 1.0) ? T(0.0) : n * (n - 1.0) * pow(x, n - 2.0);
        return chained(a, pow(x, n), slope, bend);
    }
    friend Jet atan2(const Jet& y, const Jet& x) {
        using std::atan2;
        const T square = x.value * x.value + y.value * y.value, turn = x.value * y.first - y.value * x.first;
        const T slope = turn / square;
        const T bend = (x.value * y.second - y.value * x.second - 2.0 * (slope * (x.value * x.first + y.value * y.first))) / square;
        return {atan2(y.value, x.value), slope, bend};
    }
    friend Jet hypot(const Jet& a, const Jet& b) {
        using std::hypot;
        const T h = hypot(a.value, b.value), slope = (a.value * a.first + b.value * b.first) / h;
        return {h, slope, (a.first * a.first + a.value * a.second + b.first * b.first + b.value * b.second - slope * slope) / h};
    }
    friend Jet choose(const Jet& a, const Jet& b, const Jet& c) {
        using expression::choose;
        return {choose(a.value, b.value, c.value), choose(a.value, b.first, c.first), choose(a.value, b.second, c.second)};
    }
    friend Jet abs(const Jet& a) { return choose(a, -a, a); }
    friend Jet minimum(const Jet& a, const Jet& b) { return choose(b - a, b, a); }
    friend Jet maximum(const Jet& a, const Jet& b) { return choose(a - b, b, a); }

private:
    static T as_value(const expression::Number& x) {
        if constexpr (std::is_same_v<T, expression::Number>)
            return x;
        else
            return T(x.value);
    }
    static bool is_zero(const T& x) {
        if constexpr (std::is_same_v<T, expression::Number>)
            return x.is_constant() && x.value == 0;
        else
            return x == T(0.0);
    }
    static Jet chained(const Jet& a, const T& f, const T& df, const T& ddf) {
        return {f, df * a.first, ddf * (a.first * a.first) + df * a.second};
    }
};

}  // namespace fettle::core::parts
