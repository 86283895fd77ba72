// SPDX-License-Identifier: MIT
/// The resultant force of contact on a body at each step's end, of one other body or of all: barrier, damping and friction
/// (adjoint/stepper/contact_forces.hpp), what a scale between them would read; or its torque about a point of the body. With every
/// integrator.
#pragma once

#include <optional>

#include "fettle/design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class ContactForce : public StepSeries {
public:
    struct Of {
        int body = 0;                    ///< what the force acts on
        std::optional<int> other;        ///< what presses; nullopt: all
        Vector3 axis = Vector3::Zero();  ///< the component along this unit vector, world; 0: the magnitude
        std::optional<Vector3> about{};  ///< the torque about this point of the body's file frame [m], in place of the force
    };
    ContactForce(const Of& of, Over over) : StepSeries(over), of_(of) {}

    const Of& of() const { return of_; }
    bool has_direction() const override { return !of_.axis.isZero(0); }
    Dimension dimension() const override { return of_.about ? Dimension::torque : Dimension::force; }
    /// A body that is not there, the same twice, two that never touch.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    std::vector<Vector3> loads(const description::Simulated& simulated) const;

    Of of_;
};

}  // namespace fettle::design::quantities
