// SPDX-License-Identifier: MIT
#include "design/reading/tolerance_cost_reader.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/expression/parse_formula.hpp"
#include "design/tolerances/iso286.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Tolerance;

void read_formula(const JsonNode& node, const Unit& unit, Tolerance& tolerance) {
    core::expression::Scope scope;
    scope.names = {{"t", core::expression::powers_of(unit.dimension)}};
    const std::string example = "; a cost is a number, or a formula of half of the width, \"1 + 0.2 mm / t\"";
    const auto formula = core::expression::parse_formula(*node.string(), scope);
    for (const Error& error : formula.errors()) node.fail(error.code, error.message + example);
    if (!formula) return;
    const double half = (tolerance.deviation.upper - tolerance.deviation.lower) / 2;
    if (!same(formula->dimension, core::expression::powers_of(Dimension::number)))
        return node.fail(ErrorCode::wrong_type, "it is " + described(formula->dimension) + ", and no plain number" + example);
    if (formula->is_constant()) return node.fail(ErrorCode::inconsistent, "it does not name `t`" + example);
    const auto at = core::expression::differentiated(*formula, std::vector<double>{half});
    if (!std::isfinite(at.value) || !at.gradient.allFinite())
        return node.fail(ErrorCode::not_finite, "it, or its derivative, is not a finite number at the tolerance as it stands");
    if (!(at.gradient[0] <= 0))
        return node.fail(ErrorCode::out_of_range, "it rises with the width: a wider tolerance costs less, not more");
    tolerance.cost.formula = *formula;
}

// The letters of a class, "H" of "H7"; empty: it is stated in another way.
std::string letters_of(const std::string& stated) {
    const auto digit = std::find_if(stated.begin(), stated.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    const bool is_class = digit != stated.begin() && digit != stated.end() &&
                          std::all_of(stated.begin(), digit, [](unsigned char c) { return std::isalpha(c) != 0; }) &&
                          std::all_of(digit, stated.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    return is_class ? std::string(stated.begin(), digit) : std::string();
}

void read_grades(const JsonNode& node, double nominal, double times, const Unit& unit, Tolerance& tolerance) {
    if (unit.dimension != Dimension::length) return node.fail(ErrorCode::wrong_type, "grades of ISO 286 are of a length");
    node.allow_keys({"IT5", "IT6", "IT7", "IT8", "IT9", "IT10", "IT11", "IT12", "IT13", "IT14"});
    const std::string letters = letters_of(tolerance.stated);
    for (const auto& [name, entry] : node.members()) {
        if (!name.starts_with("IT")) continue;
        const auto cost = entry.number(core::files::not_negative);
        const std::string grade = name.substr(2), wanted = (letters.empty() ? "js" : letters) + grade;
        const auto limits = tolerances::iso286_limits(wanted, times * nominal, entry.where());
        for (const Error& error : limits.errors()) entry.fail(error.code, error.message);
        if (cost && limits)
            tolerance.cost.choices.push_back({letters.empty() ? name : wanted, limits->lower / times, limits->upper / times, *cost});
    }
    const auto width = [](const description::ToleranceChoice& choice) { return choice.upper - choice.lower; };
    std::sort(tolerance.cost.choices.begin(), tolerance.cost.choices.end(),
              [&](const auto& a, const auto& b) { return width(a) < width(b); });
    if (node.is_object() && tolerance.cost.choices.empty())
        node.fail(ErrorCode::missing_key, "it names no grade: {\"IT7\": 2, \"IT8\": 1}");
}

}  // namespace

void read_cost(const JsonNode& node, double nominal, const Unit& unit, Tolerance& tolerance) {
    tolerance.is_fixed = node["fixed"].boolean().value_or(false);
    const JsonNode cost = node["cost"];
    if (!cost.exists()) return;
    if (cost.is_string()) return read_formula(cost, unit, tolerance);
    const double times = node["of"].is_string() && *node["of"].string() == "radius" ? 2 : 1;
    if (cost.is_object()) return read_grades(cost, nominal, times, unit, tolerance);
    tolerance.cost.as_it_stands = cost.number(core::files::positive).value_or(1);
}

}  // namespace fettle::design::reading
