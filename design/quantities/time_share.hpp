// SPDX-License-Identifier: MIT
/// The share of the time, or of a drive's travel x, during which a quantity's numbers, interpolated (interpolant.hpp), are above a
/// threshold c(p), or below it: of a follower that dwells, of a part that is in contact. From the crossings t_i, with x(t) = t without a
/// drive,
///   q = sum_i (x(end of part i) - x(its begin)) / (x(end) - x(start)),   dx(t_i) = sum_k w_k dx_k + x'(t_i) dt_i,   dt_i as in
///   event_time.hpp
/// It is continuous where a crossing comes or goes, with a kink. Numbers that rest on the threshold are neither above nor below it: then
/// the value is no number, with a fault that says so.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class TimeShare : public description::Quantity {
public:
    struct Of {
        std::shared_ptr<const StepSeries> series;  ///< its numbers; plain (Reduction::is_plain)
        core::expression::Formula threshold;       ///< of the design's parameters, in the unit of the numbers (SI)
        bool is_above = true;
        std::shared_ptr<const StepSeries> along{};  ///< the drive, plain too; null: the time
        std::optional<double> from{}, to{};         ///< of this part of the motion alone [s]
        std::string name = "the quantity";          ///< what messages call the quantity
    };
    explicit TimeShare(Of of) : of_(std::move(of)) {}

    const Of& of() const { return of_; }
    Dimension dimension() const override { return Dimension::number; }
    description::QuantityFacts facts() const override { return {.is_number = true}; }
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    struct Parts;
    Parts parts(const description::Simulated& simulated) const;
    int first_instant() const;  // from which on there are numbers of both

    Of of_;
};

}  // namespace fettle::design::quantities
