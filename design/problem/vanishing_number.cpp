// SPDX-License-Identifier: MIT
#include "design/problem/vanishing_number.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace fettle::design::problem {

namespace {

using core::expression::Node;
using core::expression::Nodes;
using core::expression::Operation;
using core::geometry::Range;

// c_0 + sum c_i x_i: c_i by atom, without those that are 0; c_0 is that of atom -1.
using Sum = std::map<int, double>;

class Sums {
public:
    explicit Sums(const Nodes& nodes) {
        for (const Node& node : nodes) sums_.push_back(sum_of(node));
    }

    const Sum& last() const { return sums_.back(); }
    // The node that an atom is.
    int node_of(int atom) const { return nodes_of_atoms_[atom]; }

private:
    const Sum& operand(const Node& node, int k) const { return sums_[node.operands[static_cast<size_t>(k)]]; }

    static Sum constant(double x) { return x == 0 ? Sum{} : Sum{{constant_atom, x}}; }
    static bool is_constant(const Sum& x) { return x.empty() || (x.size() == 1 && x.begin()->first == constant_atom); }
    static double value_of(const Sum& x) { return x.empty() ? 0 : x.begin()->second; }

    static Sum scaled(const Sum& x, double by) {
        Sum out;
        for (const auto& [atom, c] : x)
            if (c * by != 0) out[atom] = c * by;
        return out;
    }
    static Sum added(Sum x, const Sum& y, double sign) {
        for (const auto& [atom, c] : y)
            if ((x[atom] += sign * c) == 0) x.erase(atom);
        return x;
    }

    Sum sum_of(const Node& node) {
        switch (node.operation) {
            case Operation::constant:
                return constant(node.number);
            case Operation::add:
                return added(operand(node, 0), operand(node, 1), 1);
            case Operation::subtract:
                return added(operand(node, 0), operand(node, 1), -1);
            case Operation::negate:
                return scaled(operand(node, 0), -1);
            case Operation::multiply:
                if (is_constant(operand(node, 0))) return scaled(operand(node, 1), value_of(operand(node, 0)));
                if (is_constant(operand(node, 1))) return scaled(operand(node, 0), value_of(operand(node, 1)));
                return atom(node);
            case Operation::divide:
                if (is_constant(operand(node, 1))) return scaled(operand(node, 0), 1 / value_of(operand(node, 1)));
                return atom(node);
            default:
                return atom(node);
        }
    }

    Sum atom(const Node& node) {
        std::vector<std::vector<double>> operands;
        for (int k = 0; k < core::expression::operand_count(node.operation); ++k) {
            std::vector<double>& written = operands.emplace_back();
            for (const auto& [of, c] : operand(node, k)) written.insert(written.end(), {static_cast<double>(of), c});
        }
        if (node.operation == Operation::multiply) std::sort(operands.begin(), operands.end());
        std::vector<double> key{static_cast<double>(node.operation), node.operation == Operation::input ? node.operands[0] + 0.0 : 0.0};
        for (const std::vector<double>& written : operands) {
            key.push_back(static_cast<double>(written.size()));
            key.insert(key.end(), written.begin(), written.end());
        }
        const auto [found, is_new] = atoms_.try_emplace(key, count_of(nodes_of_atoms_));
        if (is_new) nodes_of_atoms_.push_back(count_of(sums_));
        return {{found->second, 1.0}};
    }

    static constexpr int constant_atom = -1;
    std::vector<Sum> sums_;
    std::map<std::vector<double>, int> atoms_;
    std::vector<int> nodes_of_atoms_;
};

}  // namespace

bool vanishes(const core::expression::Number& number, std::span<const Range> inputs, double allowed) {
    if (number.is_constant()) return std::abs(number.value) <= allowed;
    const Nodes nodes = core::expression::needed_for(number.tape->nodes(), number.node);
    const Sums sums(nodes);
    const std::vector<Range> values = core::expression::values<Range>(nodes, inputs);
    double most = 0;
    for (const auto& [atom, c] : sums.last()) most += std::abs(c) * (atom < 0 ? 1 : values[sums.node_of(atom)].magnitude());
    return most <= allowed;
}

}  // namespace fettle::design::problem
