// SPDX-License-Identifier: MIT
/// Formulas of design files, such as `crank_radius / rod_length`, `max(a, b) + 2 mm`, `'long name' ^ 2`:
///   + - * / ^ ( )   as usual: -a^2 is -(a^2), a^b^c is a^(b^c)
///   min(a, b, ...)  max(a, b, ...)  sqrt(a)  abs(a)  sin(a)  cos(a)      sin and cos of an angle, or of a number, which is in radians
///   numbers         with a unit where they have a dimension: `2 mm`, `30deg`; of a unit as much is read as there is one: 2 mm^2 is two
///                   square millimetres, (2 mm)^2 are four
///   parameters      by name; in single quotes where the name is no word (letters, digits, _ and .)
/// Dimensions are checked: what is added or compared has one dimension, and an exponent is a number (a constant one, unless its base is a
/// number too).
/// By hand: libraries of formulas neither check dimensions nor differentiate on our dual numbers, nor say where in the text a fault is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/design/description/parameter.hpp"
#include "fettle/design/description/relation.hpp"
#include "fettle/design/reading/dimension_powers.hpp"

namespace fettle::design::reading {

/// What one instruction does to the stack of values.
enum class Operation { number, parameter, negate, add, subtract, multiply, divide, power, minimum, maximum, root, absolute, sine, cosine };

struct Instruction {
    Operation operation = Operation::number;
    double number = 0;  ///< SI (Operation::number)
    int parameter = 0;  ///< (Operation::parameter)
};

/// A formula in reverse Polish order.
struct Expression {
    std::vector<Instruction> code;
    DimensionPowers dimension;
};

/// Errors, as many as can be found, each with the place in the text: syntax (parse), names and functions that do not exist, with the
/// nearest one (out_of_range), dimensions that do not go together (wrong_type). `where` is copied into each.
Result<Expression> parse_expression(std::string_view text, const std::vector<description::Parameter>& parameters,
                                    const std::string& where = {});

/// Value and gradient at p (SI), exact up to rounding, by forward differentiation. The side that min, max and abs take is
/// differentiated, and the first one where they are equal. Not finite where the formula or its derivative is not.
description::RelationValue evaluate(const Expression& expression, const VectorX& p);

}  // namespace fettle::design::reading
