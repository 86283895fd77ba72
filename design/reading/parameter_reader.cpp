// SPDX-License-Identifier: MIT
#include "fettle/design/reading/parameter_reader.hpp"

#include <set>

#include "fettle/design/reading/move_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Parameter;

// Of what a parameter can move, and pure numbers.
std::vector<std::string_view> parameter_unit_names() {
    std::vector<std::string_view> names;
    for (const Dimension dimension :
         {Dimension::length, Dimension::angle, Dimension::speed, Dimension::angular_speed, Dimension::acceleration, Dimension::force,
          Dimension::torque, Dimension::stiffness, Dimension::density, Dimension::number}) {
        for (const Unit& unit : units()) {
            if (unit.dimension == dimension) names.push_back(unit.name);
        }
    }
    return names;
}

// " mm"; of a pure number nothing.
std::string in_unit(const Unit& unit) { return unit.dimension == Dimension::number ? "" : " " + std::string(unit.name); }

class ParameterReader {
public:
    ParameterReader(const ReadContext& context, const Shapes& shapes, const Unit& default_unit)
        : context_(context), shapes_(shapes), default_unit_(default_unit) {}

    Parameter read(const JsonNode& node) {
        Parameter parameter;
        node.allow_keys({"name", "description", "value", "lower", "upper", "unit", "moves"});
        if (!node.is_object()) return parameter;
        node["description"].string();
        read_name(node.require("name"), parameter);
        const auto unit = node["unit"].choice(parameter_unit_names());
        parameter.unit = unit ? *find_unit(*unit) : default_unit_;
        read_range(node, parameter);
        const JsonNode moves = node.require("moves");
        if (moves.is_array() && moves.elements().empty()) moves.fail(ErrorCode::out_of_range, "a parameter that moves nothing");
        for (const JsonNode& entry : moves.objects()) {
            for (description::Move& move : read_moves(entry, context_, shapes_, parameter)) parameter.moves.push_back(std::move(move));
        }
        return parameter;
    }

private:
    void read_name(const JsonNode& node, Parameter& parameter) {
        parameter.name = node.string().value_or("");
        if (!node.is_string()) return;
        if (parameter.name.empty()) node.fail(ErrorCode::out_of_range, "a parameter's name is not empty");
        if (!names_.insert(parameter.name).second) {
            node.fail(ErrorCode::inconsistent, "another parameter is called " + node.shown() + " already; names are unique");
        }
    }

    void read_range(const JsonNode& node, Parameter& parameter) {
        const auto value = node.require("value").number(), lower = node.require("lower").number(), upper = node.require("upper").number();
        if (lower && upper && *lower > *upper) {
            node["lower"].fail(ErrorCode::inconsistent, "the lower bound " + node["lower"].shown() + " is above the upper bound " +
                                                            node["upper"].shown() + " of parameter \"" + parameter.name + "\"");
        } else if (value && lower && upper && (*value < *lower || *value > *upper)) {
            node["value"].fail(ErrorCode::out_of_range, "the value " + node["value"].shown() + " lies outside the bounds [" +
                                                            node["lower"].shown() + ", " + node["upper"].shown() + "]" +
                                                            in_unit(parameter.unit));
        }
        parameter.value = to_si(value.value_or(0), parameter.unit);
        parameter.lower = to_si(lower.value_or(0), parameter.unit);
        parameter.upper = to_si(upper.value_or(0), parameter.unit);
    }

    const ReadContext& context_;
    const Shapes& shapes_;
    const Unit& default_unit_;
    std::set<std::string> names_;
};

}  // namespace

std::vector<Parameter> read_parameters(const JsonNode& node, const ReadContext& context, const Shapes& shapes, const Unit& default_unit) {
    ParameterReader reader(context, shapes, default_unit);
    std::vector<Parameter> parameters;
    for (const JsonNode& entry : node.elements()) parameters.push_back(reader.read(entry));
    if (node.is_array() && parameters.empty()) node.fail(ErrorCode::out_of_range, "a design needs a parameter");
    return parameters;
}

}  // namespace fettle::design::reading
