// SPDX-License-Identifier: MIT
/// A number that depends on variables t_k in [-1, 1], enclosed by a linear function of them and a rest: for all t
///   | x(t) - (center + sum over k of slopes[k] t_k) | <= rest.
/// Unlike an interval it knows how it depends on the variables, so that what depends on them alike cancels in a difference; the rest is of
/// second order in their ranges. A Taylor model of first order (Makino and Berz 2003); where a function is too bent over its argument's
/// range, or has a kink there, it is the interval of its values, as in affine arithmetic (Stolfi and de Figueiredo 1997).
///
/// All operations of formulas (expression/operation.hpp). Centers and slopes are doubles, and the rounding of every operation is in the
/// rest; elementary functions and their derivatives are enclosed by geometry/range.hpp. What is not bounded, or not defined somewhere in
/// the range, has an infinite rest.
#pragma once

#include <array>
#include <cmath>

#include "core/geometry/interval.hpp"
#include "core/geometry/range.hpp"

namespace fettle::core::certificate {

/// The most variables of one pair of bodies: coordinates of joints and deviations of dimensions together.
inline constexpr int most_variables = 12;

struct TaylorModel {
    double center = 0;
    std::array<double, most_variables> slopes{};
    double rest = 0;  ///< >= 0

    TaylorModel() = default;
    TaylorModel(double exact) : center(exact) {}  // NOLINT: a number is a model
    /// All numbers of an interval, without a slope.
    static TaylorModel of(const geometry::Interval& values);
    /// Variable k over [low, high], all of it. Contract: 0 <= k < most_variables, low <= high.
    static TaylorModel variable(int k, double low, double high);
    static TaylorModel unknown();

    bool is_bounded() const { return rest < HUGE_VAL; }  // false for NaN
    /// At least the largest |x - center|.
    double radius() const;
    /// The interval of all its values.
    geometry::Interval interval() const;
    /// At least |x|.
    double magnitude() const { return geometry::upper(std::abs(center) + radius()); }
};

/// Its value at a place t, which need not be in [-1, 1]; without the rest.
double linear_value(const TaylorModel& x, const std::array<double, most_variables>& t);

inline TaylorModel operator+(const TaylorModel& a) { return a; }
TaylorModel operator-(const TaylorModel& a);
TaylorModel operator+(const TaylorModel& a, const TaylorModel& b);
TaylorModel operator-(const TaylorModel& a, const TaylorModel& b);
TaylorModel operator*(const TaylorModel& a, const TaylorModel& b);
TaylorModel operator/(const TaylorModel& a, const TaylorModel& b);
/// By a number: half the work.
TaylorModel scaled(double by, const TaylorModel& a);

TaylorModel sqrt(const TaylorModel& a);
TaylorModel sin(const TaylorModel& a);
TaylorModel cos(const TaylorModel& a);
TaylorModel tan(const TaylorModel& a);
TaylorModel asin(const TaylorModel& a);
TaylorModel acos(const TaylorModel& a);
TaylorModel atan(const TaylorModel& a);
TaylorModel exp(const TaylorModel& a);
TaylorModel log(const TaylorModel& a);
TaylorModel pow(const TaylorModel& a, const TaylorModel& b);
TaylorModel atan2(const TaylorModel& y, const TaylorModel& x);
TaylorModel hypot(const TaylorModel& a, const TaylorModel& b);
TaylorModel choose(const TaylorModel& a, const TaylorModel& b, const TaylorModel& c);
TaylorModel abs(const TaylorModel& a);
TaylorModel minimum(const TaylorModel& a, const TaylorModel& b);
TaylorModel maximum(const TaylorModel& a, const TaylorModel& b);

using Model3 = std::array<TaylorModel, 3>;
using ModelMatrix = std::array<Model3, 3>;  ///< rows

Model3 operator+(const Model3& a, const Model3& b);
Model3 operator-(const Model3& a, const Model3& b);
TaylorModel dot(const Model3& a, const Model3& b);
Model3 times(const ModelMatrix& m, const Model3& x);
Model3 transposed_times(const ModelMatrix& m, const Model3& x);
ModelMatrix product(const ModelMatrix& a, const ModelMatrix& b);
ModelMatrix transposed(const ModelMatrix& m);

/// I + sin(angle) [axis] + (1 - cos(angle)) [axis]^2: the rotation about an axis of length 1.
ModelMatrix turned_about(const Model3& axis, const TaylorModel& angle);

}  // namespace fettle::core::certificate
