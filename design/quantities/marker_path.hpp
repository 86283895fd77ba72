// SPDX-License-Identifier: MIT
/// Mean squared distance of a marker, a point fixed to a body, from target points [m^2]; all of them may follow from parameters.
/// With times: the marker at that time, linear between the configurations before and after it (exact at the configurations).
/// Without: free timing; each target point counts its distance from the nearest point of the polyline through the marker's positions,
/// whose derivative holds the nearest place fixed (envelope theorem).
#pragma once

#include <vector>

#include "design/quantities/own_formula.hpp"

namespace fettle::design::quantities {

class MarkerPath : public description::Quantity {
public:
    /// @param point    In the body's file frame [m].
    /// @param targets  World [m], at least one.
    /// @param times    [s] within the simulation, as many as targets; or empty: free timing.
    MarkerPath(int body, OwnPoint point, std::vector<OwnPoint> targets, std::vector<double> times);

    int body() const { return body_; }
    const OwnPoint& point() const { return point_; }
    const std::vector<OwnPoint>& targets() const { return targets_; }
    const std::vector<double>& times() const { return times_; }
    Dimension dimension() const override { return Dimension::area; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// Three for each target: its distance's coordinates, over the root of their number.
    VectorX deviations(const description::Simulated& simulated) const override;
    void add_deviation_seeds(const description::Simulated& simulated, int i, double scale, description::Seeds& seeds) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    /// The marker's place that counts for a target: (1 - fraction) * position[index] + fraction * position[index + 1].
    struct Place {
        int index = 0;
        double fraction = 0;
        Vector3 position = Vector3::Zero(), target = Vector3::Zero();
    };
    std::vector<Place> places(const description::Simulated& simulated) const;
    Place nearest(const std::vector<Vector3>& path, const Vector3& target) const;

    /// Adds the seeds of direction . (the place that counts for target k - the target).
    void add_place_seeds(const description::Simulated& simulated, const Place& place, int k, const Vector3& direction,
                         description::Seeds& seeds) const;

    int body_;
    OwnPoint point_;
    std::vector<OwnPoint> targets_;
    std::vector<double> times_;
};

}  // namespace fettle::design::quantities
