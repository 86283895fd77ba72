// SPDX-License-Identifier: MIT
/// A formula of other quantities and of the design's parameters: max_force / mass, travel_a - travel_b, stroke - 2 * gap.
///   J = f(q_1, .., q_n, p),   dJ = sum df/dq_i dq_i + df/dp dp
/// so that one sweep backwards serves it, however many quantities it names. Its proof follows from theirs: its bounds
/// enclose f over their bounds, rounding of f included (core/geometry/range.hpp), and are proven if all of theirs are. Where one of
/// them can meet no bound, it meets none either.
///
///     const auto ratio = Expression::parse("force / mass", {{"force", force}, {"mass", mass}}, design.parameters);
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/expression/formula.hpp"
#include "design/description/parameter.hpp"
#include "design/description/quantity.hpp"

namespace fettle::design::quantities {

using description::NamedQuantity;

class Expression : public description::Quantity {
public:
    /// @param formula  Its inputs are names of `parts`; all others are parameters. Parts that it does not name are left out.
    /// Errors: a dimension that has no unit (wrong_type).
    static Result<std::shared_ptr<const Expression>> create(core::expression::Formula formula, const std::vector<NamedQuantity>& parts);

    /// Parses a text (core/expression/parse_formula.hpp) that names parts, and parameters of the design; numbers without a unit count in
    /// SI.
    static Result<std::shared_ptr<const Expression>> parse(std::string_view text, const std::vector<NamedQuantity>& parts,
                                                           const std::vector<description::Parameter>& parameters = {});

    const core::expression::Formula& formula() const { return formula_; }
    const std::vector<NamedQuantity>& parts() const { return parts_; }
    Dimension dimension() const override { return dimension_; }
    description::QuantityFacts facts() const override;
    description::Measurement value(const description::Simulated& simulated) const override;
    void add_seeds(const description::Simulated& simulated, const description::Measurement& measured, double scale,
                   description::Seeds& seeds) const override;
    bool is_at_rest() const override;
    bool is_about(int scenario) const override;
    std::vector<std::string> parameters() const override;
    std::string explanation(const description::Measurement& measured) const override;
    /// That of the first of its parts that has one.
    std::string doubt(const description::Simulated& simulated, const description::Measurement& measured) const override;
    Errors check(const core::model::Model& model, int steps) const override;

private:
    Expression(core::expression::Formula formula, std::vector<NamedQuantity> parts, Dimension dimension);
    int part_of(const std::string& input) const;  // -1: a parameter
    template <class T, class PartValue>
    std::vector<T> inputs(const description::Simulated& simulated, PartValue part_value) const;

    core::expression::Formula formula_;
    std::vector<NamedQuantity> parts_;
    Dimension dimension_;
};

/// The names that an expression may use besides parameters, as parse_formula wants them.
std::vector<core::expression::Scope::Name> names_of(const std::vector<NamedQuantity>& parts);

/// A formula from a text that names these quantities, and parameters of the design; where one name is both the quantity is meant.
Result<core::expression::Formula> formula_of_quantities(std::string_view text, std::vector<core::expression::Scope::Name> names,
                                                        const std::vector<description::Parameter>& parameters);

}  // namespace fettle::design::quantities
