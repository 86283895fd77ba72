// SPDX-License-Identifier: MIT
/// A formula of what other quantities are at the same instant, of the time, and of the design's parameters:
///   y_t = f(u_t, .., time_t, p),   dy_t = sum df/du du_t + df/dp dp
/// A deviation from a law (lift - 3 mm * sin(turn)), a transmission error (turn_b - 2 * turn_a), power (torque * speed / 1 rad), an angle
/// between links are each one formula. Parts that say nothing but a derivative (Reduction::is_plain) stand for their numbers, others, such
/// as a peak or a mass, for the one that they come to, the same at each instant; an expression stands for what it is of its parts at each
/// instant (over_steps). It has a number at the start if all that it names have one.
///
///     const auto error = StepExpression::parse("output - 2 * input", {{"output", output}, {"input", input}}, Over::peak);
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "design/quantities/expression.hpp"
#include "design/quantities/step_series.hpp"

namespace fettle::design::quantities {

class StepExpression : public StepSeries {
public:
    static constexpr std::string_view time = "time";

    /// @param formula  Its inputs are names of `parts`, `time`, and parameters. Parts that it does not name are left out.
    /// Errors: a dimension that has no unit (wrong_type); a part that is no StepSeries, Stroke or Mass: one that is known within bounds
    /// alone, or of a scenario of its own (unsupported).
    static Result<std::shared_ptr<const StepExpression>> create(core::expression::Formula formula, const std::vector<NamedQuantity>& parts,
                                                                const Reduction& reduction);

    /// Parses a text, as Expression::parse.
    static Result<std::shared_ptr<const StepExpression>> parse(std::string_view text, const std::vector<NamedQuantity>& parts,
                                                               const Reduction& reduction,
                                                               const std::vector<description::Parameter>& parameters = {});

    const core::expression::Formula& formula() const { return formula_; }
    const std::vector<NamedQuantity>& parts() const { return parts_; }
    Dimension instant_dimension() const override { return instant_dimension_; }
    description::QuantityFacts facts() const override;
    bool has_start() const override;
    std::vector<std::string> parameters() const override;
    Errors check(const core::model::Model& model, int steps) const override;

protected:
    std::vector<double> series(const description::Simulated& simulated) const override;
    void add_series_seeds(const description::Simulated& simulated, const std::vector<double>& weights,
                          description::Seeds& seeds) const override;

private:
    StepExpression(core::expression::Formula formula, std::vector<NamedQuantity> parts, Dimension dimension, const Reduction& reduction);
    int part_of(const std::string& input) const;  // -1: a parameter, or the time
    std::vector<std::vector<double>> inputs(const description::Simulated& simulated) const;

    core::expression::Formula formula_;
    std::vector<NamedQuantity> parts_;
    Dimension instant_dimension_;
};

/// A quantity as it stands in an expression over the steps: an expression of numbers is the formula of its parts at each instant, which at
/// the end is that expression. Others are themselves.
std::shared_ptr<const description::Quantity> over_steps(const std::shared_ptr<const description::Quantity>& quantity);

/// The names that an expression over the steps may use besides parameters, as parse_formula wants them.
std::vector<core::expression::Scope::Name> step_names_of(const std::vector<NamedQuantity>& parts);

}  // namespace fettle::design::quantities
