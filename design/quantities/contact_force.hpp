// SPDX-License-Identifier: MIT
/// The resultant force of contact on a body at each step's end, of one other body or of all: barrier, damping and friction
/// (adjoint/stepper/contact_forces.hpp), what a scale between them would read; or its torque about a point of the body. With every
/// integrator.
#pragma once

#include <optional>

#include "fettle/design/quantities/vector_series.hpp"

namespace fettle::design::quantities {

class ContactForce : public VectorSeries {
public:
    struct Of {
        int body = 0;                    ///< what the force acts on
        std::optional<int> other;        ///< what presses; nullopt: all
        Vector3 axis = Vector3::Zero();  ///< the component along this unit vector, world; 0: the magnitude
        std::optional<Vector3> about{};  ///< the torque about this point of the body's file frame [m], in place of the force
    };
    ContactForce(const Of& of, const Reduction& reduction) : VectorSeries(of.axis, reduction), of_(of) {}

    const Of& of() const { return of_; }
    Dimension step_dimension() const override { return of_.about ? Dimension::torque : Dimension::force; }
    /// A body that is not there, the same twice, two that never touch.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<Vector3> vectors(const description::Simulated& simulated) const override;
    void add_vector_seeds(const description::Simulated& simulated, const std::vector<Vector3>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
