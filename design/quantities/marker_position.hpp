// SPDX-License-Identifier: MIT
/// Where a marker is, a point of a body's file frame, at the start and at each step's end [m], world: p = q + R X - origin (marker.hpp).
/// Its derivatives in time are velocity and acceleration by differences of the steps, with every integrator, quasi-statics too;
/// marker_speed.hpp has the integrator's own velocity.
#pragma once

#include "design/quantities/own_formula.hpp"
#include "design/quantities/vector_series.hpp"

namespace fettle::design::quantities {

class MarkerPosition : public VectorSeries {
public:
    struct Of {
        int body = 0;
        OwnPoint point{};                ///< in the body's file frame [m]
        Vector3 axis = Vector3::Zero();  ///< the component along this unit vector, world; 0: the magnitude, of a position the distance
        OwnPoint origin{};               ///< from here, world [m]
    };
    MarkerPosition(const Of& of, const Reduction& reduction) : VectorSeries(of.axis, reduction), of_(of) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return Dimension::length; }
    bool has_start() const override { return true; }
    std::vector<std::string> parameters() const override;
    bool has_direction() const override { return reduction().derivative > 0 && VectorSeries::has_direction(); }
    /// A body that is not there.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<Vector3> vectors(const description::Simulated& simulated) const override;
    void add_vector_seeds(const description::Simulated& simulated, const std::vector<Vector3>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
