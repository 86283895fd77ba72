// SPDX-License-Identifier: MIT
#include "core/expression/operation.hpp"

#include <iterator>
#include <limits>

namespace fettle::core::expression {
namespace {

constexpr const char* operation_names[] = {"constant",  "input",   "negate",        "root",       "absolute",    "sine",
                                           "cosine",    "tangent", "arc_sine",      "arc_cosine", "arc_tangent", "exponential",
                                           "logarithm", "add",     "subtract",      "multiply",   "divide",      "power",
                                           "minimum",   "maximum", "arc_tangent_2", "hypotenuse", "choose"};
static_assert(std::size(operation_names) == static_cast<std::size_t>(Operation::choose) + 1);

}  // namespace

const char* to_string(Operation operation) { return operation_names[static_cast<std::size_t>(operation)]; }

std::optional<Operation> operation_of(std::string_view name) {
    const auto found = std::find(std::begin(operation_names), std::end(operation_names), name);
    if (found == std::end(operation_names)) return std::nullopt;
    return static_cast<Operation>(found - std::begin(operation_names));
}

std::array<double, 3> slopes(Operation operation, double a, double b, double, double value, bool exponent_varies) {
    switch (operation) {
        case Operation::negate:
            return {-1, 0, 0};
        case Operation::root:
            return {0.5 / value, 0, 0};
        case Operation::absolute:
            return {a < 0 ? -1.0 : 1.0, 0, 0};
        case Operation::sine:
            return {std::cos(a), 0, 0};
        case Operation::cosine:
            return {-std::sin(a), 0, 0};
        case Operation::tangent:
            return {1 + value * value, 0, 0};
        case Operation::arc_sine:
            return {1 / std::sqrt((1 - a) * (1 + a)), 0, 0};
        case Operation::arc_cosine:
            return {-1 / std::sqrt((1 - a) * (1 + a)), 0, 0};
        case Operation::arc_tangent:
            return {1 / (1 + a * a), 0, 0};
        case Operation::exponential:
            return {value, 0, 0};
        case Operation::logarithm:
            return {1 / a, 0, 0};
        case Operation::add:
            return {1, 1, 0};
        case Operation::subtract:
            return {1, -1, 0};
        case Operation::multiply:
            return {b, a, 0};
        case Operation::divide:
            return {1 / b, -value / b, 0};
        case Operation::power:  // a constant exponent needs no logarithm, so its base may be zero or negative
            return {b == 0 ? 0 : b * std::pow(a, b - 1), exponent_varies ? value * std::log(a) : 0, 0};
        case Operation::minimum:
            return {b < a ? 0.0 : 1.0, b < a ? 1.0 : 0.0, 0};
        case Operation::maximum:
            return {b > a ? 0.0 : 1.0, b > a ? 1.0 : 0.0, 0};
        case Operation::arc_tangent_2:
            return {b / (a * a + b * b), -a / (a * a + b * b), 0};
        case Operation::hypotenuse:
            return {a / value, b / value, 0};
        case Operation::choose:
            return {0, a < 0 ? 1.0 : 0.0, a < 0 ? 0.0 : 1.0};
        case Operation::constant:
        case Operation::input:
            break;
    }
    return {0, 0, 0};
}

double distance_to_kink(Operation operation, double a, double b) {
    switch (operation) {
        case Operation::minimum:
        case Operation::maximum:
            return std::abs(a - b);
        case Operation::absolute:
        case Operation::choose:
            return std::abs(a);
        default:
            return std::numeric_limits<double>::infinity();
    }
}

}  // namespace fettle::core::expression
