// SPDX-License-Identifier: MIT
#include "core/part_files/part_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/limits.hpp"

namespace fettle::core::part_files {

using base::Dimension;
using base::ErrorCode;
using expression::Formula;
using files::JsonNode;

PartNumbers::PartNumbers(double length_unit) : unit_(length_unit) {
    scope_.what = "dimension, count or variable";
    scope_.plain_unit = expression::plain_units(length_unit);
}

void PartNumbers::add_dimension(const std::string& name, Dimension dimension) {
    names_.push_back(name);
    scope_.names.push_back({name, expression::powers_of(dimension)});
}

void PartNumbers::add_count(const std::string& name, int value) { scope_.names.push_back({name, {}, expression::constant_formula(value)}); }

void PartNumbers::add_variables(const JsonNode& node) {
    std::map<std::string, std::string> texts;
    for (const auto& [name, value] : node.members()) {
        if (name.starts_with('#')) continue;
        if (!expression::is_possible_name(name)) {
            value.fail(ErrorCode::out_of_range, "a variable's name is not empty and has no single quote in it");
        } else if (scope_.find(name) != nullptr) {
            value.fail(ErrorCode::inconsistent, "`" + name + "` is a dimension or a count already; names are unique");
        } else if (value.is_string()) {
            texts[name] = *value.string();
        } else if (value.number()) {
            texts[name] = value.shown();
        }
    }
    const Errors errors = expression::define_variables(texts, scope_, [&](const std::string& name, Formula formula) {
        expression::Scope::Name out{name, formula.dimension};
        if (formula.is_constant()) {
            out.meaning = std::move(formula);
        } else {
            variables_.emplace_back(name, number_of(std::move(formula)));
            names_.push_back(name);
        }
        return out;
    });
    for (const Error& error : errors) node[error.where].fail(error.code, error.message);
}

std::vector<Number> PartNumbers::values(std::vector<Number> dimensions) const {
    for (const auto& [name, number] : variables_) dimensions.push_back(number.at<Number>(dimensions, Number(0)));
    return dimensions;
}

PartNumber PartNumbers::number_of(Formula formula) const {
    PartNumber out;
    for (const std::string& input : formula.inputs) {
        const bool is_parameter = !parameter_.empty() && input == parameter_;
        const auto found = std::find(names_.begin(), names_.end(), input);
        out.positions.push_back(is_parameter ? -1 : static_cast<int>(found - names_.begin()));
    }
    out.formula = std::move(formula);
    return out;
}

PartNumber PartNumbers::given(const JsonNode& node, const Result<Formula>& formula) const {
    if (formula) return number_of(*formula);
    for (const Error& error : formula.errors()) node.fail(error.code, error.message);
    return {};
}

PartNumber PartNumbers::number(const JsonNode& node, Dimension dimension) const {
    if (node.is_string() && node.string()->starts_with('='))
        return given(node, expression::parse_formula_of(*node.string(), scope_, dimension, si_per_number(dimension)));
    const auto value = node.quantity(dimension, si_per_number(dimension));
    return {expression::constant_formula(value.value_or(0), expression::powers_of(dimension))};
}

PartNumber PartNumbers::number_of_any(const JsonNode& node) const {
    if (node.is_string()) return given(node, expression::parse_formula(*node.string(), scope_));
    return {expression::constant_formula(node.number().value_or(0))};
}

std::optional<PartNumber> PartNumbers::parsed(const std::string& text, const JsonNode& node) const {
    const Result<Formula> formula = expression::parse_formula(text, scope_);
    for (const Error& error : formula.errors()) node.fail(error.code, error.message);
    if (!formula) return std::nullopt;
    return number_of(*formula);
}

std::optional<int> PartNumbers::count(const JsonNode& node, int least, int most) const {
    if (!node.exists()) return std::nullopt;
    const std::size_t faults = node.error_count();
    const PartNumber number = this->number(node, Dimension::number);
    if (node.error_count() > faults) return std::nullopt;
    if (!number.formula.is_constant()) {
        node.fail(ErrorCode::wrong_type, "how many there are follows from counts alone; `" + number.formula.inputs.front() +
                                             "` is a dimension, which may change while a design is tuned");
        return std::nullopt;
    }
    const double value = number.formula.nodes.back().number;
    if (std::round(value) == value && value >= least && value <= most) return static_cast<int>(value);
    node.fail(ErrorCode::out_of_range, node.shown() + " is " + std::to_string(value) + "; allowed: whole numbers from " +
                                           std::to_string(least) + " to " + std::to_string(most));
    return std::nullopt;
}

void PartNumbers::with_parameter(const std::string& name, const expression::DimensionPowers& dimension, const std::function<void()>& read) {
    scope_.names.push_back({name, dimension});
    parameter_ = name;
    read();
    parameter_.clear();
    scope_.names.pop_back();
}

parts::Point2 PartPoint::at(const Sheet& sheet) const {
    return is_polar ? parts::polar(first.at(sheet), second.at(sheet)) : parts::Point2{first.at(sheet), second.at(sheet)};
}

bool is_point(const JsonNode& node) { return node.is_array() || (node.is_object() && node["polar"].exists()); }

PartPoint read_point(const JsonNode& node, const PartNumbers& numbers) {
    PartPoint out;
    if (!node.exists()) return out;
    out.is_polar = node.is_object();
    if (out.is_polar) node.allow_keys({"polar"});
    const JsonNode list = out.is_polar ? node.require("polar") : node;
    const std::vector<JsonNode> two = list.is_array() ? list.elements() : std::vector<JsonNode>();
    if (two.size() != 2) {
        if (list.exists())
            list.fail(ErrorCode::wrong_type, "expected a point, [x, y] or {\"polar\": [distance, angle]}, found " + list.shown());
        return out;
    }
    out.first = numbers.length(two[0]);
    out.second = out.is_polar ? numbers.angle(two[1]) : numbers.length(two[1]);
    return out;
}

PartPoint3 read_point3(const JsonNode& node, const PartNumbers& numbers, Dimension dimension) {
    if (!node.exists()) return {};
    const std::vector<JsonNode> three = node.is_array() ? node.elements() : std::vector<JsonNode>();
    if (three.size() != 3) {
        node.fail(ErrorCode::wrong_type, "expected a list of three, [x, y, z], found " + node.shown());
        return {};
    }
    return {numbers.number(three[0], dimension), numbers.number(three[1], dimension), numbers.number(three[2], dimension)};
}

Errors located(Errors errors, const std::string& where) {
    for (Error& error : errors)
        if (error.where.find('#') == std::string::npos) error.where = where;
    return errors;
}

}  // namespace fettle::core::part_files
