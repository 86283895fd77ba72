// SPDX-License-Identifier: MIT
/// Forward automatic differentiation: a value and its gradient with respect to a few inputs. Shape generators are written once
/// on it (mesh_builder.hpp); their Jacobian is exact up to rounding.
///   f(a, b):  gradient = df/da * a.gradient + df/db * b.gradient
/// Comparisons look at the value only: a branch is differentiated on the side that was taken.
/// By hand: Eigen's AutoDiffScalar is unsupported and makes expressions that dangle in such code; this is one page.
#pragma once

#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "fettle/core/base/contract.hpp"

namespace fettle::design::shapes {

/// A number with a gradient of `Size` entries, or of a size known at run time.
/// A run-time gradient of size 0 is that of a constant and goes with any other; two non-constant operands must have the same size.
template <int Size = Eigen::Dynamic>
struct Dual {
    using Gradient = Eigen::Matrix<double, Size, 1>;

    double value = 0;
    Gradient gradient = zero_gradient();

    Dual() = default;
    Dual(double constant) : value(constant) {}  // NOLINT: implicit by design, constants mix with duals
    Dual(double v, Gradient g) : value(v), gradient(std::move(g)) {}

    /// Input number `index` of `count`: gradient = unit vector. Contract: 0 <= index < count, and count == Size where that is fixed.
    static Dual variable(double v, int index, int count) {
        FETTLE_ASSERT(index >= 0 && index < count && (Size == Eigen::Dynamic || Size == count), "dual variable out of range");
        return Dual(v, Gradient::Unit(count, index));
    }

    /// Derivative with respect to input `index`; 0 of a constant.
    double derivative(int index) const { return gradient.size() == 0 ? 0.0 : gradient[index]; }

    Dual& operator+=(const Dual& b) { return *this = *this + b; }
    Dual& operator-=(const Dual& b) { return *this = *this - b; }
    Dual& operator*=(const Dual& b) { return *this = *this * b; }
    Dual& operator/=(const Dual& b) { return *this = *this / b; }

    friend Dual operator+(const Dual& a) { return a; }
    friend Dual operator-(const Dual& a) { return Dual(-a.value, -a.gradient); }
    friend Dual operator+(const Dual& a, const Dual& b) { return Dual(a.value + b.value, combine(1, a, 1, b)); }
    friend Dual operator-(const Dual& a, const Dual& b) { return Dual(a.value - b.value, combine(1, a, -1, b)); }
    friend Dual operator*(const Dual& a, const Dual& b) { return Dual(a.value * b.value, combine(b.value, a, a.value, b)); }
    friend Dual operator/(const Dual& a, const Dual& b) {
        const double quotient = a.value / b.value;
        return Dual(quotient, combine(1 / b.value, a, -quotient / b.value, b));
    }

    friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
    friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
    friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
    friend bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
    friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
    friend bool operator!=(const Dual& a, const Dual& b) { return a.value != b.value; }

    /// Contract of the derivative: a.value > 0 (it is infinite at 0).
    friend Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return Dual(root, a.gradient * (0.5 / root));
    }
    friend Dual sin(const Dual& a) { return Dual(std::sin(a.value), a.gradient * std::cos(a.value)); }
    friend Dual cos(const Dual& a) { return Dual(std::cos(a.value), a.gradient * -std::sin(a.value)); }

private:
    static Gradient zero_gradient() { return Gradient::Zero(Size == Eigen::Dynamic ? 0 : Size); }

    static Gradient combine(double alpha, const Dual& a, double beta, const Dual& b) {
        if (a.gradient.size() == 0) return beta * b.gradient;
        if (b.gradient.size() == 0) return alpha * a.gradient;
        FETTLE_ASSERT(a.gradient.size() == b.gradient.size(), "duals of different inputs do not mix");
        return alpha * a.gradient + beta * b.gradient;
    }
};

/// Value of a plain number or a dual, for code on a generic scalar.
inline double value_of(double a) { return a; }
template <int Size>
double value_of(const Dual<Size>& a) {
    return a.value;
}

}  // namespace fettle::design::shapes
