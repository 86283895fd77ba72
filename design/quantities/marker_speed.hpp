// SPDX-License-Identifier: MIT
/// Velocity of a marker, a point X of a body's file frame relative to its reference point, at each step's end:
///   v = V [X; 1],   V the integrator's end velocity (adjoint/stepper/velocities.hpp)   [m/s], world
#pragma once

#include "design/quantities/own_formula.hpp"
#include "design/quantities/vector_series.hpp"

namespace fettle::design::quantities {

class MarkerSpeed : public VectorSeries {
public:
    struct Of {
        int body = 0;
        OwnPoint point{};                ///< in the body's file frame [m]
        Vector3 axis = Vector3::Zero();  ///< the component along this unit vector, world; 0: the magnitude
    };
    MarkerSpeed(const Of& of, const Reduction& reduction) : VectorSeries(of.axis, reduction), of_(of) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return Dimension::speed; }
    std::vector<std::string> parameters() const override;
    /// A body that is not there; a quasi-static simulation.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<Vector3> vectors(const description::Simulated& simulated) const override;
    void add_vector_seeds(const description::Simulated& simulated, const std::vector<Vector3>& weights,
                          description::Seeds& seeds) const override;

private:
    Eigen::Vector4d place(const description::Simulated& simulated) const;

    Of of_;
};

}  // namespace fettle::design::quantities
