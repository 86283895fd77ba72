// SPDX-License-Identifier: MIT
/// Mean squared distance of a marker, a point fixed to a body, from target points [m^2].
/// With times: the marker at that time, linear between the configurations before and after it (exact at the configurations).
/// Without: free timing; each target point counts its distance from the nearest point of the polyline through the marker's positions,
/// whose derivative holds the nearest place fixed (envelope theorem).
#pragma once

#include <vector>

#include "fettle/core/expression/formula.hpp"
#include "fettle/design/description/quantity.hpp"

namespace fettle::design::quantities {

/// A coordinate of a target that follows from the design's parameters [m].
struct MovedCoordinate {
    int target = 0;  ///< counted from 0
    int axis = 0;    ///< 0, 1, 2
    core::expression::Formula formula;
};

class MarkerPath : public description::Quantity {
public:
    /// @param point    In the body's file frame [m].
    /// @param targets  World [m], at least one.
    /// @param times    [s] within the simulation, as many as targets; or empty: free timing.
    /// @param moved    Coordinates in place of those of `targets`.
    MarkerPath(int body, const Vector3& point, std::vector<Vector3> targets, std::vector<double> times,
               std::vector<MovedCoordinate> moved = {});

    int body() const { return body_; }
    const Vector3& point() const { return point_; }
    const std::vector<Vector3>& targets() const { return targets_; }
    const std::vector<MovedCoordinate>& moved() const { return moved_; }
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
    std::vector<Vector3> targets_at(const description::Simulated& simulated) const;
    Place nearest(const std::vector<Vector3>& path, const Vector3& target) const;

    int body_;
    Vector3 point_;
    std::vector<Vector3> targets_;
    std::vector<double> times_;
    std::vector<MovedCoordinate> moved_;
};

}  // namespace fettle::design::quantities
