// SPDX-License-Identifier: MIT
/// Functions of time that drive joints and forces.
#pragma once

#include <optional>
#include <vector>

namespace fettle::core::scene {

enum class CurveKind {
    linear,         ///< piecewise linear through (times, values)
    cubic,          ///< the cubic Hermite curve through them, at rest at its ends; slopes by the parabola through three entries
    trapezoid,      ///< from entry to entry, at rest at each: even acceleration, even speed, even deceleration, each a third of the time
    control_points  ///< the clamped uniform cubic B-spline of the values over [times.front(), times.back()]; at least 4 values
};

/// u(t) = rate t + table(t), the table constant outside its times; after `stop_time` (if any) u stays as it is.
struct Curve {
    CurveKind kind = CurveKind::linear;
    double rate = 0;                  ///< [unit/s]
    std::vector<double> times;        ///< [s], increasing; empty: no table; control_points: the first and the last
    std::vector<double> values;       ///< as many as times; control_points: at least 4
    std::optional<double> stop_time;  ///< [s]
};

double curve_value(const Curve& curve, double time);

/// du/d(rate) at `time` [s].
double curve_running_time(const Curve& curve, double time);

/// du/d(values[k]) at `time`: u is linear in its values.
std::vector<double> curve_weights(const Curve& curve, double time);

}  // namespace fettle::core::scene
