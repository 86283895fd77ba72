// SPDX-License-Identifier: MIT
/// Arithmetic that is recorded while it runs. A part (core/parts) is drawn once with `Number`s; what was recorded then is evaluated again
/// on other kinds of numbers, and differentiated:
///
///     Tape tape;
///     const Number radius = tape.input(5e-3), gap = tape.input(2e-4);
///     const Number bore = radius + gap;                      // bore.value == 5.2e-3, and the tape knows how it came about
///     const MatrixX slopes = gradients(tape, values(tape, inputs));   // of every node with respect to every input
///
/// Comparisons look at the value: which side a program takes is decided while it is recorded, and holds for that recording. What depends on
/// no input is not recorded.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/expression/operation.hpp"

namespace fettle::core::expression {

class Tape;

/// A value, and where on the tape it is from; without a tape a constant. Cheap to copy; lives no longer than its tape.
struct Number {
    double value = 0;
    Tape* tape = nullptr;
    int node = -1;

    Number() = default;
    Number(double constant) : value(constant) {}  // NOLINT: constants mix with recorded numbers
    Number(double v, Tape* t, int n) : value(v), tape(t), node(n) {}

    bool is_constant() const { return tape == nullptr; }

    Number& operator+=(const Number& b);
    Number& operator-=(const Number& b);
    Number& operator*=(const Number& b);
    Number& operator/=(const Number& b);
};

class Tape {
public:
    /// The next input. Its value is the one that decisions are made by.
    Number input(double value);
    int input_count() const { return input_count_; }
    const Nodes& nodes() const { return nodes_; }

    /// Records operation(a, b, c) and returns it; a constant if all operands are. Contract: operands of this tape, or constants.
    static Number record(Operation operation, const Number& a, const Number& b = {}, const Number& c = {});
    /// The node that holds x: its own, or a new one of a constant. For lists of nodes that are evaluated together.
    int node_of(const Number& x);

private:
    Nodes nodes_;
    int input_count_ = 0;
};

inline Number operator+(const Number& a) { return a; }
inline Number operator-(const Number& a) { return Tape::record(Operation::negate, a); }
inline Number operator+(const Number& a, const Number& b) { return Tape::record(Operation::add, a, b); }
inline Number operator-(const Number& a, const Number& b) { return Tape::record(Operation::subtract, a, b); }
inline Number operator*(const Number& a, const Number& b) { return Tape::record(Operation::multiply, a, b); }
inline Number operator/(const Number& a, const Number& b) { return Tape::record(Operation::divide, a, b); }
inline Number& Number::operator+=(const Number& b) { return *this = *this + b; }
inline Number& Number::operator-=(const Number& b) { return *this = *this - b; }
inline Number& Number::operator*=(const Number& b) { return *this = *this * b; }
inline Number& Number::operator/=(const Number& b) { return *this = *this / b; }

inline bool operator<(const Number& a, const Number& b) { return a.value < b.value; }
inline bool operator>(const Number& a, const Number& b) { return a.value > b.value; }
inline bool operator<=(const Number& a, const Number& b) { return a.value <= b.value; }
inline bool operator>=(const Number& a, const Number& b) { return a.value >= b.value; }

inline Number sqrt(const Number& a) { return Tape::record(Operation::root, a); }
inline Number abs(const Number& a) { return Tape::record(Operation::absolute, a); }
inline Number sin(const Number& a) { return Tape::record(Operation::sine, a); }
inline Number cos(const Number& a) { return Tape::record(Operation::cosine, a); }
inline Number tan(const Number& a) { return Tape::record(Operation::tangent, a); }
inline Number asin(const Number& a) { return Tape::record(Operation::arc_sine, a); }
inline Number acos(const Number& a) { return Tape::record(Operation::arc_cosine, a); }
inline Number atan(const Number& a) { return Tape::record(Operation::arc_tangent, a); }
inline Number exp(const Number& a) { return Tape::record(Operation::exponential, a); }
inline Number log(const Number& a) { return Tape::record(Operation::logarithm, a); }
inline Number pow(const Number& a, const Number& b) { return Tape::record(Operation::power, a, b); }
inline Number atan2(const Number& a, const Number& b) { return Tape::record(Operation::arc_tangent_2, a, b); }
inline Number hypot(const Number& a, const Number& b) { return Tape::record(Operation::hypotenuse, a, b); }
inline Number minimum(const Number& a, const Number& b) { return Tape::record(Operation::minimum, a, b); }
inline Number maximum(const Number& a, const Number& b) { return Tape::record(Operation::maximum, a, b); }
inline Number choose(const Number& a, const Number& b, const Number& c) { return Tape::record(Operation::choose, a, b, c); }

/// The nodes that node `last` needs, and itself, alone and in their order; their operands count through the new list.
/// Contract: every input has one node.
Nodes needed_for(const Nodes& nodes, int last);

/// The value of every node, on numbers of type T (operation.hpp). @param inputs  One for each input of the list.
template <class T>
std::vector<T> values(const Nodes& nodes, std::span<const T> inputs) {
    std::vector<T> out;
    out.reserve(nodes.size());
    const T none(0.0);
    for (const Node& node : nodes) {
        const int count = operand_count(node.operation);
        const auto operand = [&](int k) -> const T& { return k < count ? out[node.operands[k]] : none; };
        if (node.operation == Operation::constant)
            out.emplace_back(node.number);
        else if (node.operation == Operation::input)
            out.push_back(inputs[node.operands[0]]);
        else
            out.push_back(applied<T>(node.operation, operand(0), operand(1), operand(2)));
    }
    return out;
}

/// d(node)/d(input), inputs x nodes, exact up to rounding: one sweep forwards.
/// @param at  values(nodes, inputs) where the derivative is taken.
MatrixX gradients(const Nodes& nodes, std::span<const double> at, int input_count);

/// sum_k weights[k] d(node k)/d(input), one sweep backwards. @param weights  One per node.
VectorX weighted_gradient(const Nodes& nodes, std::span<const double> at, std::span<const double> weights, int input_count);

/// Least distance_to_kink over the nodes, relative to the larger operand; infinity where there is no kink at all.
double nearest_kink(const Nodes& nodes, std::span<const double> at);

}  // namespace fettle::core::expression
