// SPDX-License-Identifier: MIT
/// Stroke of a body along a world axis: largest minus smallest coordinate axis . q over the motion, of its reference point.
///
/// The extremes are those of a curve that runs through the configurations (extreme.hpp), not of the configurations themselves.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

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
    description::QuantityFacts facts() const override { return {.is_number = true, .curve = Dimension::length}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// The way along the axis from the start.
    std::vector<double> curve(const description::Simulated& simulated) const override;
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
