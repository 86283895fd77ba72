// SPDX-License-Identifier: MIT
/// A law that a motion is to follow: a table (core/scene/curve.hpp, as a motor's) at each instant, over the time or along what another
/// quantity is then, such as the angle of a cam; its values may follow from parameters,
///   y_t = sum_k w_k(x_t) v_k(p),   x_t = time_t, or the other's number;   dy_t = sum_k w_k dv_k + y'(x_t) dx_t
/// A lift or a turn deviates from it in an expression over the steps (step_expression.hpp).
#pragma once

#include <memory>
#include <vector>

#include "core/expression/formula.hpp"
#include "core/scene/curve.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

/// A value of the table that follows from the design's parameters [SI].
struct MovedValue {
    int index = 0;  ///< counted from 0
    core::expression::Formula formula;
};

class Law : public StepSeries {
public:
    struct Of {
        core::scene::Curve curve;                 ///< SI
        Dimension dimension = Dimension::length;  ///< of its values
        std::vector<MovedValue> moved{};          ///< in place of those of `curve`
        std::shared_ptr<const StepSeries> along;  ///< what the table is over, in place of the time; null: the time
    };
    Law(Of of, const Reduction& reduction) : StepSeries(reduction), of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension instant_dimension() const override { return of_.dimension; }
    bool has_start() const override { return !of_.along || of_.along->has_start(); }
    std::vector<std::string> parameters() const override;
    /// A table that is none: no value for each time, times that do not increase. What it is along is not plain (Reduction::is_plain).
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    core::scene::Curve curve_of(const description::Simulated& simulated) const;
    std::vector<double> places(const description::Simulated& simulated) const;

    Of of_;
};

}  // namespace fettle::design::quantities
