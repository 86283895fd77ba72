// SPDX-License-Identifier: MIT
/// Stroke of a body along a world axis: largest minus smallest coordinate axis . q over the motion, of its reference point.
///
/// The extremes are taken of the parabola through the three configurations round the extremal one, not of the configurations themselves:
/// closer to the truth (the error of a cosine falls from (omega h)^2/8 of its amplitude, at worst, to 3 (omega h)^4/128), and smooth in the
/// parameters where the largest of many numbers has kinks. At the first or last configuration, or where the three do not bend, it is the
/// configuration's own coordinate.
///   y(i + s) = y_i + b s + a s^2,  b = (y_+ - y_-)/2,  a = (y_+ - 2 y_i + y_-)/2;   extreme y_i - b^2/(4a)  at  s = -b/(2a), |s| <= 1/2
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "fettle/core/expression/formula.hpp"
#include "fettle/design/description/quantity.hpp"

namespace fettle::design::quantities {

/// An extreme as a weighted sum of up to three consecutive coordinates: its derivative in them is these weights (envelope theorem).
struct Extreme {
    double value = 0;
    int first = 0;                           ///< index of the first of the three
    std::array<double, 3> weights{0, 0, 0};  ///< d value / d y[first + k]; sum 1
};
/// Largest value of the sequence in the sense above. Contract: not empty. The earliest of equal ones.
Extreme smooth_maximum(const std::vector<double>& y);

/// A part of the motion: the configurations at times within it, the start included [s]. Default: all of it.
struct StrokeWindow {
    std::optional<double> from{}, to{};
};

class Stroke : public description::Quantity {
public:
    /// @param axis    Unit vector, world.
    /// @param target  If given, the value is (stroke - target)^2 [m^2], else the stroke [m].
    Stroke(int body, const Vector3& axis, std::optional<double> target, StrokeWindow window = {})
        : body_(body), axis_(axis), window_(window) {
        if (target) target_ = core::expression::constant_formula(*target, core::expression::powers_of(Dimension::length));
    }
    /// @param target  A formula of the design's parameters [m].
    Stroke(int body, const Vector3& axis, core::expression::Formula target, StrokeWindow window = {})
        : body_(body), axis_(axis), target_(std::move(target)), window_(window) {}

    int body() const { return body_; }
    const Vector3& axis() const { return axis_; }
    const std::optional<core::expression::Formula>& target() const { return target_; }
    const StrokeWindow& window() const { return window_; }
    Dimension dimension() const override { return target_ ? Dimension::area : Dimension::length; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    VectorX deviations(const description::Simulated& simulated) const override;
    void add_deviation_seeds(const description::Simulated& simulated, int i, double scale, description::Seeds& seeds) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    std::pair<int, int> configurations(double timestep, int steps) const;  // [first, second) that are in the window
    std::vector<double> coordinates(const description::Simulated& simulated, double sign) const;
    double stroke(const description::Simulated& simulated) const;
    double deviation(const description::Simulated& simulated) const;  // from the target; without one the stroke

    int body_;
    Vector3 axis_;
    std::optional<core::expression::Formula> target_;
    StrokeWindow window_;
};

}  // namespace fettle::design::quantities
