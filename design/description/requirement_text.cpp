// SPDX-License-Identifier: MIT
#include "design/description/requirement_text.hpp"

#include <cmath>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/expression/dimension_powers.hpp"

namespace fettle::design::description {

namespace {

constexpr int bound_digits = 7;

std::string number_text(double number, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, number);
    return text;
}

std::string with_unit(const std::string& number, const std::string& unit_name) {
    return unit_name.empty() ? number : number + " " + unit_name;
}

}  // namespace

std::string unit_name(const Constraint& constraint) {
    return core::base::unit_name(constraint.quantity->dimension(), constraint.bounds.unit);
}

std::string unit_name(const Relation& relation) {
    if (!relation.formula) return {};
    const auto dimension = core::expression::named_dimension(relation.formula->dimension);
    return dimension ? core::base::unit_name(*dimension, relation.bounds.unit) : std::string();
}

std::string objective_unit(const Design& design) {
    if (design.objective.size() != 1 || std::abs(design.objective.front().weight) != 1) return {};
    const ObjectiveTerm& term = design.objective.front();
    return core::base::unit_name(term.quantity->dimension(), term.unit);
}

std::string amount_text(double si, double unit, const std::string& unit_name, int digits) {
    return with_unit(number_text(si / unit, digits), unit_name);
}

std::string required_text(const Bounds& bounds, const std::string& unit_name) {
    constexpr int digits = 7;
    const std::string lower = number_text(bounds.lower / bounds.unit, digits), upper = number_text(bounds.upper / bounds.unit, digits);
    const std::string over = bounds.over_tolerances ? " " + words(*bounds.over_tolerances) : "";
    if (bounds.lower == bounds.upper) return "exactly " + with_unit(lower, unit_name) + over;
    if (!std::isfinite(bounds.upper)) return "at least " + with_unit(lower, unit_name) + over;
    if (!std::isfinite(bounds.lower)) return "at most " + with_unit(upper, unit_name) + over;
    return lower + " to " + with_unit(upper, unit_name) + over;
}

std::string bound_text(double si, Towards towards, double unit, const std::string& unit_name) {
    const auto text = [](double number) { return number_text(number, bound_digits); };
    return with_unit(core::base::bound_text(si, unit, unit, towards, text), unit_name);
}

std::string known_text(const Measurement& measured, const Bounds& bounds, const std::string& unit_name) {
    const std::string what = measured.is_proven ? "proven " : "computed ";
    const auto nearest = [&](double si) { return number_text(si / bounds.unit, bound_digits); };
    if (nearest(measured.lower) != nearest(measured.upper))
        return what + bound_text(measured.lower, Towards::down, bounds.unit, "") + " to " +
               bound_text(measured.upper, Towards::up, bounds.unit, unit_name);
    // One number: on the side of the limit that is nearer.
    const bool is_upper_nearer = bounds.upper - measured.upper < measured.lower - bounds.lower;
    return what + (is_upper_nearer ? bound_text(measured.upper, Towards::up, bounds.unit, unit_name)
                                   : bound_text(measured.lower, Towards::down, bounds.unit, unit_name));
}

}  // namespace fettle::design::description
