// SPDX-License-Identifier: MIT
/// A condition between parameters alone, known without a simulation: lower <= r(p) <= upper. A ratio, a sum, Grashof's condition. Read from
/// a design file by reading/relation_reader.hpp. Made by a program:
///
///     design.relations.push_back({.name = "slenderness", .bounds = {.upper = 0.35}, .at = [](const VectorX& p) {
///         return RelationValue{p[0] / p[1], Vector2(1 / p[1], -p[0] / (p[1] * p[1]))};
///     }});
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/base/types.hpp"
#include "core/expression/formula.hpp"
#include "design/description/choice.hpp"
#include "design/description/constraint.hpp"
#include "design/description/parameter.hpp"

namespace fettle::design::description {

struct RelationValue {
    double value = 0;  ///< r(p)
    VectorX gradient;  ///< dr/dp, n
};

struct Relation {
    std::string name;
    Bounds bounds = {};    ///< lower == upper: an equation. The margin keeps an optimiser's end, which is not exact, on the right side
    double tolerance = 0;  ///< how far beyond its bounds it still counts as met; of an equation above 0, since parameters are rounded
    /// The value at all of the design's parameters, in their order, SI. A pure function, exact up to rounding; called from several threads
    /// at once. Where it is not defined: a value or a gradient that is not finite; such a design is not evaluated.
    std::function<RelationValue(const VectorX&)> at = {};
    std::optional<core::expression::Formula> formula = {};  ///< what `at` evaluates, of parameters; none: made by a program
    std::optional<ChoiceFormula> by_choices = {};           ///< of a relation that no parameter changes, but choices of the design do
};

/// A formula of parameters as what a relation asks for. Contract: its inputs are among these parameters.
std::function<RelationValue(const VectorX&)> function_of(const core::expression::Formula& formula,
                                                         const std::vector<Parameter>& parameters);

/// max(0, lower - value, value - upper) in units of the bounds, 0 within the tolerance; infinity for a value that is not a number.
double violation(const Relation& relation, double value);

}  // namespace fettle::design::description
