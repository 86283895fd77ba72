// SPDX-License-Identifier: MIT
/// How far a body has turned about a fixed axis n of the world since the start, where it is 0, at each step's end: with x normal to n, y =
/// n x x and u = R_t R_0^T x,
///   angle = atan2(y . u, x . u)   [rad], turns counted from step to step
/// For bodies that real pins hold, which have no joint. A body that tilts is measured as seen along n; contract of the derivative: u is not
/// along n.
#pragma once

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class BodyTurn : public StepSeries {
public:
    /// @param axis  A unit vector, world.
    BodyTurn(int body, const Vector3& axis, const Reduction& reduction) : StepSeries(reduction), body_(body), axis_(axis) {}

    int body() const { return body_; }
    const Vector3& axis() const { return axis_; }
    Dimension instant_dimension() const override { return Dimension::angle; }
    bool has_start() const override { return true; }
    bool has_direction() const override { return reduction().derivative > 0; }
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    int body_;
    Vector3 axis_;
};

}  // namespace fettle::design::quantities
