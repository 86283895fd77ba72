// SPDX-License-Identifier: MIT
/// The coordinate of a joint at the start and at each step's end: the angle of a revolute, the travel of a prismatic one, as motors and
/// limits count it (core/measure/measure.hpp). Angles count turns, as the start does (Mechanism::angles_start).
#pragma once

#include <string>

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class JointPosition : public StepSeries {
public:
    struct Of {
        std::string joint;
        Dimension dimension = Dimension::angle;  ///< of its coordinate: angle or length
    };
    JointPosition(Of of, const Reduction& reduction) : StepSeries(reduction), of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return of_.dimension; }
    bool has_start() const override { return true; }
    bool has_direction() const override { return reduction().derivative > 0; }
    /// A joint that is not there, or has no coordinate of that dimension.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
