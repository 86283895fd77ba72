// SPDX-License-Identifier: MIT
/// Series of vectors of the world, of which a quantity has the component along an axis, else the magnitude; derivatives in time are the
/// vectors' own. Kinds: marker_position.hpp, marker_speed.hpp, contact_force.hpp.
#pragma once

#include <vector>

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class VectorSeries : public StepSeries {
public:
    /// @param axis  A unit vector; 0: the magnitude, whose derivative at 0 is taken for 0.
    VectorSeries(const Vector3& axis, const Reduction& reduction) : StepSeries(reduction), axis_(axis) {}

    bool has_direction() const override { return !axis_.isZero(0); }

protected:
    virtual std::vector<Vector3> vectors(const description::Simulated& simulated) const = 0;
    /// Adds the seeds of sum_t weights[t] . vectors()[t].
    virtual void add_vector_seeds(const description::Simulated& simulated, const std::vector<Vector3>& weights,
                                  description::Seeds& seeds) const = 0;
    std::vector<double> series(const description::Simulated& simulated) const final;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const final;
    std::vector<double> series_derivative(const description::Simulated& simulated, int order) const final;
    void add_series_derivative_seeds(const description::Simulated& simulated, int order, const std::vector<double>& weights,
                                     description::Seeds& seeds) const final;

private:
    Vector3 axis_;
};

}  // namespace fettle::design::quantities
