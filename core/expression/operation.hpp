// SPDX-License-Identifier: MIT
/// The operations that formulas (formula.hpp) and parts (tape.hpp) are made of: how many operands each has, its value on any kind of
/// number, and its derivative. One list for both, so that what can be written can be differentiated, enclosed in intervals and recorded.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace fettle::core::expression {

enum class Operation : std::uint8_t {
    constant,  ///< Node::number
    input,     ///< the input whose index is operands[0]
    // of one operand
    negate,
    root,
    absolute,
    sine,
    cosine,
    tangent,
    arc_sine,
    arc_cosine,
    arc_tangent,
    exponential,
    logarithm,  ///< natural
    // of two
    add,
    subtract,
    multiply,
    divide,
    power,
    minimum,
    maximum,
    arc_tangent_2,  ///< atan2(a, b)
    hypotenuse,     ///< sqrt(a^2 + b^2)
    // of three
    choose  ///< a < 0 ? b : c
};

constexpr int operand_count(Operation operation) {
    if (operation < Operation::negate) return 0;
    if (operation < Operation::add) return 1;
    return operation < Operation::choose ? 2 : 3;
}

/// As written above: "negate".
const char* to_string(Operation operation);
std::optional<Operation> operation_of(std::string_view name);

/// One operation on the values of earlier nodes of its list.
struct Node {
    Operation operation = Operation::constant;
    std::array<int, 3> operands{0, 0, 0};
    double number = 0;
};
using Nodes = std::vector<Node>;

// The first of two equal values is taken. Intervals and recorded numbers have overloads of their own.
inline double minimum(double a, double b) { return b < a ? b : a; }
inline double maximum(double a, double b) { return b > a ? b : a; }
inline double choose(double a, double b, double c) { return a < 0 ? b : c; }

/// The operation's value on numbers of type T: double, or one whose functions (sqrt, sin, minimum, ...) stand in its namespace.
/// Operands that the operation does not have are not looked at. Contract: neither a constant nor an input.
template <class T>
T applied(Operation operation, const T& a, const T& b, const T& c) {
    using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::exp, std::hypot, std::log, std::pow, std::sin, std::sqrt,
        std::tan;
    switch (operation) {
        case Operation::negate:
            return -a;
        case Operation::root:
            return sqrt(a);
        case Operation::absolute:
            return abs(a);
        case Operation::sine:
            return sin(a);
        case Operation::cosine:
            return cos(a);
        case Operation::tangent:
            return tan(a);
        case Operation::arc_sine:
            return asin(a);
        case Operation::arc_cosine:
            return acos(a);
        case Operation::arc_tangent:
            return atan(a);
        case Operation::exponential:
            return exp(a);
        case Operation::logarithm:
            return log(a);
        case Operation::add:
            return a + b;
        case Operation::subtract:
            return a - b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::power:
            return pow(a, b);
        case Operation::minimum:
            return minimum(a, b);
        case Operation::maximum:
            return maximum(a, b);
        case Operation::arc_tangent_2:
            return atan2(a, b);
        case Operation::hypotenuse:
            return hypot(a, b);
        case Operation::choose:
            return choose(a, b, c);
        case Operation::constant:
        case Operation::input:
            break;
    }
    return a;
}

/// d(value)/d(operand) of each operand at a, b, c; `value` is the operation's value there. The side that minimum, maximum, absolute and
/// choose take is differentiated, and the first one where they are equal; choose has no derivative in its condition. Where there is none (a
/// root at 0), infinity or NaN. The derivative of a^b in b is asked for only where b varies: it needs a logarithm.
std::array<double, 3> slopes(Operation operation, double a, double b, double c, double value, bool exponent_varies);

/// How near the operands are to where the derivative jumps: |a - b| of minimum and maximum, |a| of absolute and choose; infinity of the
/// others.
double distance_to_kink(Operation operation, double a, double b);

}  // namespace fettle::core::expression
