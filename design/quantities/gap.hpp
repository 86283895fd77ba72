// SPDX-License-Identifier: MIT
/// The gap between two bodies at the start and each step's end, as contact measures it (core/clearance/contact_gap.hpp), however far apart
/// they are: contact is made where it falls below dmin + dhat. Computed, not proven: the proven distance is a clearance (clearance.hpp).
/// For events (event_time.hpp) and formulas over the steps.
#pragma once

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class Gap : public StepSeries {
public:
    struct Of {
        int a = 0, b = 0;  ///< bodies
    };
    Gap(const Of& of, const Reduction& reduction) : StepSeries(reduction), of_(of) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return Dimension::length; }
    bool has_start() const override { return true; }
    /// A body that is not there, the same twice, two that never collide.
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    Of of_;
};

}  // namespace fettle::design::quantities
