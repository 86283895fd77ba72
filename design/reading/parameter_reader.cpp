// SPDX-License-Identifier: MIT
#include "design/reading/parameter_reader.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

#include "core/base/text.hpp"
#include "design/reading/former_moves.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Parameter;

// Units of the numbers that a parameter can move, and of pure numbers.
std::vector<std::string_view> parameter_unit_names() {
    std::vector<std::string_view> names;
    for (const Dimension dimension :
         {Dimension::length, Dimension::angle, Dimension::speed, Dimension::angular_speed, Dimension::acceleration, Dimension::force,
          Dimension::torque, Dimension::stiffness, Dimension::angular_stiffness, Dimension::density, Dimension::number}) {
        for (const Unit& unit : units()) {
            if (unit.dimension == dimension) names.push_back(unit.name);
        }
    }
    return names;
}

std::string in_its_unit(double si, const Unit& unit) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", description::from_si(si, unit));
    return text;
}

// " mm"; of a pure number nothing.
std::string in_unit(const Unit& unit) { return unit.dimension == Dimension::number ? "" : " " + std::string(unit.name); }

class ParameterReader {
public:
    ParameterReader(const std::vector<core::scene::Variable>& variables, const Unit& length_unit)
        : variables_(variables), length_unit_(length_unit) {}

    Parameter read(const JsonNode& node) {
        Parameter parameter;
        node.allow_keys({"name", "description", "value", "lower", "upper", "unit", "reference", "moves"});
        if (!node.is_object()) return parameter;
        node["description"].string();
        read_name(node.require("name"), parameter);
        const auto unit = node["unit"].choice(parameter_unit_names());
        const core::scene::Variable* variable = variable_of(parameter.name);
        parameter.unit = unit ? *find_unit(*unit) : default_unit(variable);
        if (variable != nullptr && !same(variable->formula.dimension, core::expression::powers_of(parameter.unit.dimension)))
            node.fail(ErrorCode::wrong_type, "the scene's variable `" + parameter.name + "` is " + described(variable->formula.dimension) +
                                                 "; a parameter in " + std::string(parameter.unit.name) + " cannot replace it");
        read_range(node, variable, parameter);
        if (node["moves"].exists()) node["moves"].fail(ErrorCode::unsupported, instead_of_moves(node["moves"], parameter.name));
        return parameter;
    }

private:
    void read_name(const JsonNode& node, Parameter& parameter) {
        parameter.name = node.string().value_or("");
        if (!node.is_string()) return;
        if (parameter.name.empty()) node.fail(ErrorCode::out_of_range, "a parameter's name must not be empty");
        if (const std::string fault = core::base::name_fault(parameter.name); !parameter.name.empty() && !fault.empty())
            node.fail(ErrorCode::out_of_range, "its name " + fault + "; a name is text on one line");
        if (!names_.insert(parameter.name).second) {
            node.fail(ErrorCode::inconsistent, "another parameter is called " + node.shown() + " already; names are unique");
        }
    }

    const core::scene::Variable* variable_of(const std::string& name) const {
        const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const auto& variable) { return variable.name == name; });
        return found == variables_.end() ? nullptr : &*found;
    }

    Unit default_unit(const core::scene::Variable* variable) const {
        return usual_unit(
            variable == nullptr ? Dimension::length : named_dimension(variable->formula.dimension).value_or(Dimension::length),
            length_unit_);
    }

    void read_range(const JsonNode& node, const core::scene::Variable* variable, Parameter& parameter) {
        const auto read = [&](const JsonNode& from) { return from.quantity(parameter.unit.dimension, to_si(1, parameter.unit)); };
        const auto lower = read(node.require("lower")), upper = read(node.require("upper"));
        auto value = read(variable == nullptr ? node.require("value") : node["value"]);
        if (!node["value"].exists() && variable != nullptr) value = variable->value;
        const auto shown = [&](const JsonNode& from) {
            return from.exists() ? from.shown() : in_its_unit(value.value_or(0), parameter.unit);
        };
        if (lower && upper && *lower > *upper) {
            node["lower"].fail(ErrorCode::inconsistent, "the lower bound " + node["lower"].shown() + " is above the upper bound " +
                                                            node["upper"].shown() + " of parameter \"" + parameter.name + "\"");
        } else if (value && lower && upper && (*value < *lower || *value > *upper)) {
            node["value"].fail(ErrorCode::out_of_range, "the value " + shown(node["value"]) + " lies outside the bounds [" +
                                                            node["lower"].shown() + ", " + node["upper"].shown() + "]" +
                                                            in_unit(parameter.unit));
        }
        if (node["reference"].exists()) parameter.reference = read(node["reference"]);
        parameter.value = value.value_or(0);
        parameter.lower = lower.value_or(0);
        parameter.upper = upper.value_or(0);
    }

    const std::vector<core::scene::Variable>& variables_;
    const Unit& length_unit_;
    std::set<std::string> names_;
};

}  // namespace

Unit usual_unit(Dimension dimension, const Unit& length_unit) {
    if (dimension == Dimension::length) return length_unit;
    return *find_unit(dimension == Dimension::angle ? "deg" : dimension == Dimension::angular_speed ? "deg/s" : si_unit(dimension));
}

std::vector<Parameter> read_parameters(const JsonNode& node, const std::vector<core::scene::Variable>& variables, const Unit& length_unit) {
    ParameterReader reader(variables, length_unit);
    std::vector<Parameter> parameters;
    for (const JsonNode& entry : node.elements()) parameters.push_back(reader.read(entry));
    if (node.is_array() && parameters.empty()) node.fail(ErrorCode::out_of_range, "a design needs a parameter");
    return parameters;
}

}  // namespace fettle::design::reading
