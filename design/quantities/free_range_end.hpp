// SPDX-License-Identifier: MIT
/// The value of a joint's coordinate up to which it is proven free, on one way from its start, with everything else as assembled
/// (core/clearance/free_ranges.hpp): how far a lid opens before it meets its frame. The bodies keep a clearance on the way. Where nothing
/// is met within a turn, or within the reach of a slide, it is how far was looked, and changes with nothing.
///
/// It is proven: the true end lies in [lower, upper]. The value within them is where the distance at the witness is the clearance, by
/// Newton's method, so that it and its derivative (adjoint/clearance/range_adjoint.hpp) are those of one smooth function.
#pragma once

#include <optional>
#include <string>

#include "core/clearance/free_ranges.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

class FreeRangeEnd : public description::Quantity {
public:
    struct Of {
        std::string joint;
        Dimension dimension = Dimension::angle;  ///< of its coordinate
        bool is_above = true;                    ///< the way on which the coordinate grows
        double clearance = 1e-6;                 ///< that the bodies keep [m], but for those that a joint joins, which do not meet; > 0
        double reach = 1;                        ///< how far a slide is looked at [m]
        bool others_anywhere = false;            ///< the other joints anywhere within their limits
    };

    explicit FreeRangeEnd(Of of) : of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension dimension() const override { return of_.dimension; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    bool is_at_rest() const override { return true; }
    Errors check(const core::model::Model& model, int steps) const override;

private:
    Result<core::clearance::JointRanges> ranges_of(const core::model::Model& model) const;
    Result<int> coordinate_in(const Result<core::clearance::JointRanges>& ranges) const;

    Of of_;
};

}  // namespace fettle::design::quantities
