// SPDX-License-Identifier: MIT
/// When something happens: the time t at which a quantity's numbers, interpolated (interpolant.hpp), cross a threshold c(p), the first time
/// or the k-th, rising or falling:
///   y(t) = c,   dt = -(sum_k w_k dy_k - dc)/y'(t),   y(t) = sum_k w_k y_k to first order
/// so that the derivative is exact for the number that is computed. A reversal is the rate (Reduction::derivative 1) that crosses 0;
/// contact is made where a gap (gap.hpp) falls below a width, or a force of contact rises above a threshold. The times that two events have
/// between them are an expression of both.
///
/// Where the event does not happen there is no time: the value is no number, with a fault that says how near it came. To begin or end on
/// the threshold, or to touch it, is no crossing.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/quantities/interpolant.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

enum class Direction {
    either,
    rising,  ///< from below the threshold to above it
    falling
};

class EventTime : public description::Quantity {
public:
    struct Of {
        std::shared_ptr<const StepSeries> series;  ///< its numbers; plain (Reduction::is_plain)
        core::expression::Formula threshold;       ///< of the design's parameters, in the unit of the numbers (SI)
        Direction direction = Direction::either;
        int occurrence = 1;                  ///< 1: the first, 2: the second ..; -1: the last, -2: the one before it
        std::optional<double> from{}, to{};  ///< of the crossings within these times alone [s]
        std::string name = "the quantity";   ///< what messages call the quantity
    };
    explicit EventTime(Of of) : of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension dimension() const override { return Dimension::time; }
    description::QuantityFacts facts() const override { return {.is_number = true}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    /// A crossing before which another one is about to come or go, or that is about to leave the motion.
    std::string doubt(const description::Simulated& simulated, const description::Measurement& measured) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    std::vector<double> beyond(const description::Simulated& simulated) const;  // y_k - c
    double time_of(double place, double timestep) const { return (place + of_.series->first_instant()) * timestep; }
    std::vector<Crossing> crossings(const description::Simulated& simulated) const;  // that are asked for
    std::optional<Crossing> crossing(const description::Simulated& simulated) const;
    std::string crossing_text(const description::Simulated& simulated) const;
    std::string missing_text(const description::Simulated& simulated) const;
    std::string amount(double si, int digits = 4) const;

    Of of_;
};

}  // namespace fettle::design::quantities
