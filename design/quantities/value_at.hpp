// SPDX-License-Identifier: MIT
/// The value of a quantity at a time that another one says: the angle of a crank where its slide turns round, a speed where contact is
/// made,
///   y(t),   t = t(p),   dy(t) = sum_k w_k dy_k + y'(t) dt
/// with y(t) interpolated between its numbers (interpolant.hpp). Where there is no such time, or it is outside of the motion, the value is
/// no number.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class ValueAt : public description::Quantity {
public:
    struct Of {
        std::shared_ptr<const StepSeries> series;             ///< plain (Reduction::is_plain)
        std::shared_ptr<const description::Quantity> time{};  ///< of an event (event_time.hpp), or an expression of such times [s]
    };
    explicit ValueAt(Of of) : of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension dimension() const override { return of_.series->numbers_dimension(); }
    description::QuantityFacts facts() const override { return {.is_number = true}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    std::string doubt(const description::Simulated& simulated, const description::Measurement& measured) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    double place_of(double time, const description::Simulated& simulated) const;

    Of of_;
};

}  // namespace fettle::design::quantities
