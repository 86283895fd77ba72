// SPDX-License-Identifier: MIT
#include "core/expression/formula.hpp"

#include <algorithm>

#include "core/base/contract.hpp"

namespace fettle::core::expression {
namespace {

// Copies formulas into one list of nodes, with one node for each input, however often it is named.
class Assembler {
public:
    explicit Assembler(const std::map<std::string, Formula>& replacements) : replacements_(replacements) {}

    // @return the node of its value
    int add(const Formula& formula, bool replace) {
        std::vector<int> input_nodes;
        for (const std::string& name : formula.inputs) input_nodes.push_back(node_of(name, replace));
        std::vector<int> moved;
        for (Node node : formula.nodes) {
            if (node.operation == Operation::input) {
                moved.push_back(input_nodes[node.operands[0]]);
                continue;
            }
            for (int i = 0; i < operand_count(node.operation); ++i) {
                int& operand = node.operands[i];
                operand = moved[operand];
            }
            nodes.push_back(node);
            moved.push_back(count_of(nodes) - 1);
        }
        return moved.back();
    }

    Nodes nodes;
    std::vector<std::string> inputs;

private:
    int node_of(const std::string& name, bool replace) {
        const auto known = known_.find({name, replace});
        if (known != known_.end()) return known->second;
        const auto replacement = replacements_.find(name);
        int node = 0;
        if (replace && replacement != replacements_.end()) {
            node = add(replacement->second, false);
        } else if (replace) {
            node = node_of(name, false);
        } else {
            nodes.push_back({Operation::input, {count_of(inputs), 0, 0}, 0});
            inputs.push_back(name);
            node = count_of(nodes) - 1;
        }
        known_[{name, replace}] = node;
        return node;
    }

    const std::map<std::string, Formula>& replacements_;
    std::map<std::pair<std::string, bool>, int> known_;
};

}  // namespace

Formula formula_of(Nodes nodes, const std::vector<std::string>& names, const DimensionPowers& dimension) {
    Formula out{std::move(nodes), {}, dimension, {}};
    for (Node& node : out.nodes) {
        if (node.operation != Operation::input) continue;
        out.inputs.push_back(names.at(node.operands[0]));
        node.operands[0] = count_of(out.inputs) - 1;
    }
    return out;
}

Formula constant_formula(double si, const DimensionPowers& dimension) {
    return {{{Operation::constant, {0, 0, 0}, si}}, {}, dimension, {}};
}

Formula input_formula(const std::string& name, const DimensionPowers& dimension) {
    return {{{Operation::input, {0, 0, 0}, 0}}, {name}, dimension, {}};
}

Formula recorded_formula(const Number& x, const std::vector<std::string>& names, const DimensionPowers& dimension) {
    if (x.is_constant()) return constant_formula(x.value, dimension);
    return formula_of(needed_for(x.tape->nodes(), x.node), names, dimension);
}

ValueAndGradient differentiated(const Formula& formula, std::span<const double> inputs) {
    FETTLE_ASSERT(inputs.size() == formula.inputs.size(), "one value for each input");
    const std::vector<double> at = values<double>(formula.nodes, inputs);
    std::vector<double> weights(at.size(), 0);
    weights.back() = 1;
    return {at.back(), weighted_gradient(formula.nodes, at, weights, count_of(inputs))};
}

std::vector<int> positions_of(const Formula& formula, std::span<const std::string> names) {
    std::vector<int> out;
    for (const std::string& input : formula.inputs) {
        const auto found = std::find(names.begin(), names.end(), input);
        FETTLE_ASSERT(found != names.end(), "a formula's inputs are among the names");
        out.push_back(static_cast<int>(found - names.begin()));
    }
    return out;
}

Formula substituted(const Formula& formula, const std::map<std::string, Formula>& replacements) {
    Assembler assembler(replacements);
    const int value = assembler.add(formula, true);
    Formula out = formula_of(needed_for(assembler.nodes, value), assembler.inputs, formula.dimension);
    out.text = formula.text;
    return out;
}

Formula sum_of(const Formula& a, const Formula& b) {
    const Formula sum{
        {{Operation::input, {0, 0, 0}, 0}, {Operation::input, {1, 0, 0}, 0}, {Operation::add, {0, 1, 0}, 0}}, {"a", "b"}, a.dimension, {}};
    return substituted(sum, {{"a", a}, {"b", b}});
}

double nearest_kink(const Formula& formula, std::span<const double> inputs) {
    return nearest_kink(formula.nodes, values<double>(formula.nodes, inputs));
}

}  // namespace fettle::core::expression
