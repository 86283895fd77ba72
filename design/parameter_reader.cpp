// SPDX-License-Identifier: MIT
#include "fettle/design/parameter_reader.hpp"

#include <algorithm>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/scene_shapes.hpp"

namespace fettle::design {

namespace {

using core::files::JsonNode;

const std::vector<std::string_view> dof_names{"px", "py", "pz", "rx", "ry", "rz"};

class ParameterReader {
public:
    ParameterReader(const objectives::ReadContext& context, const std::string& length_unit_name)
        : context_(context), length_unit_name_(length_unit_name) {}

    Parameter read(const JsonNode& node) {
        Parameter parameter;
        parameter.where = node.where();
        node.allow_keys({"name", "description", "value", "lower", "upper", "unit", "moves"});
        if (!node.is_object()) return parameter;
        node["description"].string();
        read_name(node.require("name"), parameter);
        const std::string unit = node["unit"].choice(parameter_unit_names()).value_or(length_unit_name_);
        parameter.unit = find_parameter_unit(unit).value_or(ParameterUnit{});
        read_range(node, parameter);
        const JsonNode moves = node.require("moves");
        if (moves.is_array() && moves.elements().empty()) moves.fail(ErrorCode::out_of_range, "a parameter that moves nothing");
        for (const JsonNode& entry : moves.elements()) {
            if (entry.is_object()) read_move(entry, parameter);
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
                                                            node["lower"].shown() + ", " + node["upper"].shown() + "]");
        }
        parameter.value = to_si(value.value_or(0), parameter.unit);
        parameter.lower = to_si(lower.value_or(0), parameter.unit);
        parameter.upper = to_si(upper.value_or(0), parameter.unit);
    }

    void read_move(const JsonNode& node, Parameter& parameter) {
        Move move;
        if (node["motor"].exists()) {
            node.allow_keys({"motor", "rate", "scale", "offset"});
            read_motor(node, parameter, move);
        } else if (node["dimension"].exists()) {
            node.allow_keys({"body", "dimension", "scale", "offset"});
            read_dimension(node, parameter, move);
        } else if (node["position"].exists()) {
            node.allow_keys({"body", "position", "scale", "offset"});
            read_position(node, parameter, move);
        } else if (node["density"].exists()) {
            node.allow_keys({"body", "density", "scale", "offset"});
            read_density(node, parameter, move);
        } else {
            node.allow_keys({"body", "dimension", "position", "density", "motor", "rate", "scale", "offset"});
            node.fail(ErrorCode::missing_key,
                      "a move says what it moves: `body` with `dimension`, `position` or `density`, or `motor` with `rate`");
        }
        if (const auto body = context_.body(node.require(node["motor"].exists() ? "motor" : "body"))) {
            move.body = *body;
            if (check_target(node, move)) parameter.moves.push_back(std::move(move));
        }
    }

    // scale is a pure number if parameter and target are of one kind, else the target's amount per unit of a pure number.
    void read_scale(const JsonNode& node, const Parameter& parameter, UnitKind kind, double target_unit, Move& move) {
        move.scale = node["scale"].number().value_or(1);
        if (parameter.unit.kind == UnitKind::number && kind != UnitKind::number) {
            move.scale *= target_unit;
        } else if (parameter.unit.kind != kind) {
            node.fail(ErrorCode::inconsistent,
                      "parameter \"" + parameter.name + "\" is in " + parameter.unit.name +
                          ", which is not a measure of what it moves here; allowed is a unit of the same kind, or \"1\"");
        }
    }

    void read_dimension(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::dimension;
        move.dimension = node["dimension"].string().value_or("");
        read_scale(node, parameter, UnitKind::length, context_.length_unit, move);
        move.offset = node["offset"].length(context_.length_unit).value_or(0);
    }

    void read_position(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::position;
        move.direction = node["position"].vector3().value_or(Vector3::UnitX());
        if (move.direction.norm() == 0) node["position"].fail(ErrorCode::out_of_range, "all coefficients are 0: this moves nothing");
        read_scale(node, parameter, UnitKind::length, context_.length_unit, move);
        move.position_offset = node["offset"].length3(context_.length_unit).value_or(Vector3::Zero());
        for (int i = 0; i < 3; ++i) {
            if (move.direction[i] == 0 && move.position_offset[i] != 0) {
                node["offset"].fail(ErrorCode::inconsistent,
                                    "an offset along an axis whose coefficient is 0; the scene's position holds there");
            }
        }
    }

    void read_density(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::density;
        if (!node["density"].boolean().value_or(true)) node["density"].fail(ErrorCode::out_of_range, "`density` is true, or left out");
        read_scale(node, parameter, UnitKind::density, 1, move);
        move.offset = node["offset"].number().value_or(0);
    }

    void read_motor(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::motor_rate;
        const std::string name = node.require("rate").choice(dof_names).value_or("rz");
        move.dof = static_cast<int>(std::find(dof_names.begin(), dof_names.end(), name) - dof_names.begin());
        const ParameterUnit degrees = *find_parameter_unit("deg/s");
        const double unit = move.dof >= 3 ? degrees.factor : context_.length_unit;
        read_scale(node, parameter, move.dof >= 3 ? UnitKind::angular_speed : UnitKind::speed, unit, move);
        move.offset = node["offset"].number().value_or(0) * unit;
    }

    bool check_target(const JsonNode& node, const Move& move) {
        const core::scene::Body& body = context_.scene.bodies[static_cast<size_t>(move.body)];
        if (move.target == MoveTarget::dimension) return check_dimension(node["dimension"], body, move.dimension);
        if (move.target == MoveTarget::motor_rate && !body.prescribed[static_cast<size_t>(move.dof)]) {
            node["rate"].fail(ErrorCode::inconsistent, "body \"" + body.name + "\" has no motor on " + node["rate"].shown() +
                                                           "; give it one in the scene, under `prescribed`");
            return false;
        }
        return true;
    }

    bool check_dimension(const JsonNode& node, const core::scene::Body& body, const std::string& name) {
        if (!body.shape) {
            node.fail(ErrorCode::inconsistent, "body \"" + body.name + "\" is a mesh from a file and has no dimensions; make it a `shape`");
            return false;
        }
        const Result<shapes::GeneratedShape> shape = generate_shape(*body.shape);
        if (!shape) return false;  // the scene's own reading has said so
        if (shape->mesh.vertices != body.mesh.vertices) {
            node.fail(ErrorCode::unsupported,
                      "body \"" + body.name + "\" has a `scale` in the scene; a part that parameters move has none");
            return false;
        }
        if (std::find(shape->dimensions.begin(), shape->dimensions.end(), name) != shape->dimensions.end()) return true;
        std::vector<std::string_view> known(shape->dimensions.begin(), shape->dimensions.end());
        node.fail(ErrorCode::out_of_range, "generator \"" + body.shape->generator + "\" has no dimension " + node.shown() + "; " +
                                               core::files::did_you_mean(name, known));
        return false;
    }

    const objectives::ReadContext& context_;
    const std::string& length_unit_name_;
    std::set<std::string> names_;
};

}  // namespace

std::string unique_name(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = wanted;
    for (int k = 2; !taken.insert(name).second; ++k) name = wanted + " " + std::to_string(k);
    return name;
}

std::vector<Parameter> read_parameters(const JsonNode& node, const objectives::ReadContext& context, const std::string& length_unit_name) {
    ParameterReader reader(context, length_unit_name);
    std::vector<Parameter> parameters;
    for (const JsonNode& entry : node.elements()) parameters.push_back(reader.read(entry));
    if (node.is_array() && parameters.empty()) node.fail(ErrorCode::out_of_range, "a design needs a parameter");
    return parameters;
}

}  // namespace fettle::design
