// SPDX-License-Identifier: MIT
/// A formula over named inputs: value, dimension, exact derivative. Made from a text by parse_formula.hpp; a number of a scene, a design or
/// a part may be one.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "core/expression/dimension_powers.hpp"
#include "core/expression/operation.hpp"
#include "core/expression/tape.hpp"

namespace fettle::core::expression {

struct Formula {
    Nodes nodes;                      ///< the last one is the value; never empty. Operation::input counts through `inputs`
    std::vector<std::string> inputs;  ///< those that it depends on, by name
    DimensionPowers dimension;
    std::string text;  ///< as written; empty: made by a program

    bool is_constant() const { return inputs.empty(); }
};

Formula constant_formula(double si, const DimensionPowers& dimension = {});
/// The input itself.
Formula input_formula(const std::string& name, const DimensionPowers& dimension);

/// The formula of nodes that end with the value and whose inputs, one node each, count through `names`.
Formula formula_of(Nodes nodes, const std::vector<std::string>& names, const DimensionPowers& dimension);
/// The formula that was recorded for x; `names` are the names of the tape's inputs.
Formula recorded_formula(const Number& x, const std::vector<std::string>& names, const DimensionPowers& dimension = {});

/// The formula's value on numbers of type T. @param inputs  In the order of Formula::inputs, SI.
template <class T>
T value_of(const Formula& formula, std::span<const T> inputs) {
    return values<T>(formula.nodes, inputs).back();
}

struct ValueAndGradient {
    double value = 0;
    VectorX gradient;  ///< in the order of Formula::inputs
};
/// Exact up to rounding (operation.hpp says what is differentiated at a kink). Not finite where the formula or its derivative is not.
ValueAndGradient differentiated(const Formula& formula, std::span<const double> inputs);

/// Names in an order of their own (a design's parameters), and where a formula's inputs are among them.
/// Contract: every input is one of them.
std::vector<int> positions_of(const Formula& formula, std::span<const std::string> names);

/// The formula with some of its inputs replaced by formulas; inputs of one name are one. Contract: replacements have the dimension of what
/// they replace, where the two are looked at together.
Formula substituted(const Formula& formula, const std::map<std::string, Formula>& replacements);

/// Contract: they have one dimension.
Formula sum_of(const Formula& a, const Formula& b);

/// How near a kink of min, max, abs or if the inputs are (tape.hpp, nearest_kink); infinity where the formula has none. For warnings.
double nearest_kink(const Formula& formula, std::span<const double> inputs);

}  // namespace fettle::core::expression
