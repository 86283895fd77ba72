// SPDX-License-Identifier: MIT
#include "core/expression/tape.hpp"

#include <limits>

#include "core/base/contract.hpp"

namespace fettle::core::expression {
namespace {

// Which of a node's operands depend on an input: of a power's exponent the derivative is asked for only then.
std::vector<bool> varying(const Nodes& nodes) {
    std::vector<bool> out(nodes.size(), false);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        out[k] = nodes[k].operation == Operation::input;
        for (int i = 0; i < operand_count(nodes[k].operation); ++i) out[k] = out[k] || out[nodes[k].operands[i]];
    }
    return out;
}

// The slopes of a node in its operands at their values.
std::array<double, 3> slopes_of(const Node& node, double value, std::span<const double> at, const std::vector<bool>& varies) {
    const int count = operand_count(node.operation);
    std::array<double, 3> x{0, 0, 0};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) x[i] = at[node.operands[i]];
    const bool exponent_varies = node.operation == Operation::power && varies[node.operands[1]];
    return slopes(node.operation, x[0], x[1], x[2], value, exponent_varies);
}

}  // namespace

Number Tape::input(double value) {
    nodes_.push_back({Operation::input, {input_count_++, 0, 0}, 0});
    return {value, this, count_of(nodes_) - 1};
}

int Tape::node_of(const Number& x) {
    if (!x.is_constant()) return x.node;
    nodes_.push_back({Operation::constant, {0, 0, 0}, x.value});
    return count_of(nodes_) - 1;
}

Number Tape::record(Operation operation, const Number& a, const Number& b, const Number& c) {
    const double value = applied<double>(operation, a.value, b.value, c.value);
    Tape* tape = a.tape != nullptr ? a.tape : b.tape != nullptr ? b.tape : c.tape;
    if (tape == nullptr) return value;
    FETTLE_ASSERT((a.tape == nullptr || a.tape == tape) && (b.tape == nullptr || b.tape == tape) && (c.tape == nullptr || c.tape == tape),
                  "numbers of different tapes do not mix");
    // What leaves a number as it is needs no node.
    const auto is = [](const Number& x, double constant) { return x.is_constant() && x.value == constant; };
    if (operation == Operation::add && is(a, 0)) return b;
    if ((operation == Operation::add || operation == Operation::subtract) && is(b, 0)) return a;
    if (operation == Operation::multiply && is(a, 1)) return b;
    if ((operation == Operation::multiply || operation == Operation::divide) && is(b, 1)) return a;
    if (operation == Operation::multiply && (is(a, 0) || is(b, 0))) return 0.0;
    const int count = operand_count(operation);
    const int node_a = tape->node_of(a), node_b = count > 1 ? tape->node_of(b) : 0, node_c = count > 2 ? tape->node_of(c) : 0;
    tape->nodes_.push_back({operation, {node_a, node_b, node_c}, 0});
    return {value, tape, count_of(tape->nodes_) - 1};
}

Nodes needed_for(const Nodes& nodes, int last) {
    const auto end = static_cast<std::size_t>(last) + 1;
    std::vector<bool> is_needed(end, false);
    is_needed[end - 1] = true;
    for (std::size_t k = end; k-- > 0;)
        for (int i = 0; is_needed[k] && i < operand_count(nodes[k].operation); ++i) is_needed[nodes[k].operands[i]] = true;
    Nodes out;
    std::vector<int> moved(end, 0);
    for (std::size_t k = 0; k < end; ++k) {
        if (!is_needed[k]) continue;
        Node node = nodes[k];
        for (std::size_t i = 0; i < static_cast<std::size_t>(operand_count(node.operation)); ++i)
            node.operands[i] = moved[node.operands[i]];
        moved[k] = count_of(out);
        out.push_back(node);
    }
    return out;
}

MatrixX gradients(const Nodes& nodes, std::span<const double> at, int input_count) {
    MatrixX out = MatrixX::Zero(input_count, nodes.size());
    const std::vector<bool> varies = varying(nodes);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Node& node = nodes[k];
        auto gradient = out.col(k);
        if (node.operation == Operation::input) gradient[node.operands[0]] = 1;
        if (!varies[k]) continue;
        const auto slope = slopes_of(node, at[k], at, varies);
        for (std::size_t i = 0; i < static_cast<std::size_t>(operand_count(node.operation)); ++i)
            if (varies[node.operands[i]]) gradient += slope[i] * out.col(node.operands[i]);
    }
    return out;
}

VectorX weighted_gradient(const Nodes& nodes, std::span<const double> at, std::span<const double> weights, int input_count) {
    std::vector<double> bar(weights.begin(), weights.end());
    const std::vector<bool> varies = varying(nodes);
    VectorX out = VectorX::Zero(input_count);
    for (std::size_t k = nodes.size(); k-- > 0;) {
        const Node& node = nodes[k];
        if (bar[k] == 0 || !varies[k]) continue;
        if (node.operation == Operation::input) out[node.operands[0]] += bar[k];
        const auto slope = slopes_of(node, at[k], at, varies);
        for (std::size_t i = 0; i < static_cast<std::size_t>(operand_count(node.operation)); ++i) {
            const auto operand = static_cast<std::size_t>(node.operands[i]);
            if (varies[operand]) bar[operand] += slope[i] * bar[k];
        }
    }
    return out;
}

double nearest_kink(const Nodes& nodes, std::span<const double> at) {
    double nearest = std::numeric_limits<double>::infinity();
    const std::vector<bool> varies = varying(nodes);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (!varies[k] || operand_count(nodes[k].operation) == 0) continue;
        const double a = at[nodes[k].operands[0]];
        const double b = operand_count(nodes[k].operation) > 1 ? at[nodes[k].operands[1]] : 0;
        const double distance = distance_to_kink(nodes[k].operation, a, b);
        const double size = std::max(std::abs(a), std::abs(b));
        nearest = std::min(nearest, size > 0 ? distance / size : distance);
    }
    return nearest;
}

}  // namespace fettle::core::expression
