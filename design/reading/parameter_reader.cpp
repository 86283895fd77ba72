// SPDX-License-Identifier: MIT
#include "fettle/design/reading/parameter_reader.hpp"

#include <algorithm>
#include <set>

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/scene/mass_kind.hpp"
#include "fettle/design/reading/mechanism_move_reader.hpp"

namespace fettle::design::reading {

namespace {

using core::files::JsonNode;
using description::Move;
using description::MoveTarget;
using description::Parameter;
using Shapes = std::vector<std::shared_ptr<const description::Shape>>;

const std::vector<std::string_view> dof_names{"px", "py", "pz", "rx", "ry", "rz"};

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
        for (const JsonNode& entry : moves.objects()) read_move(entry, parameter);
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
        if (is_mechanism_move(node)) {
            if (auto read = read_mechanism_move(node, context_, parameter)) parameter.moves.push_back(std::move(*read));
            return;
        }
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
            node.allow_keys({"body",  "dimension", "position", "density", "turn",   "velocity", "angular_velocity", "force",    "torque",
                             "motor", "rate",      "joint",    "spring",  "damper", "load",     "gravity",          "material", "materials",
                             "dmin",  "mu",        "scale",    "offset"});
            node.fail(
                ErrorCode::missing_key,
                "a move says what it moves: `body` with `dimension`, `position`, `turn`, `velocity`, `angular_velocity`, `force`, "
                "`torque` or `density`, `motor` with `rate`, `speed` or `value`, `joint`, `spring`, `damper` or `load` with what of it, "
                "`gravity`, `dmin`, or a coefficient of friction: `mu`, of a `body`, a `material`, two `materials`, or of all others");
        }
        if (const auto body = context_.body(node.require(node["motor"].exists() ? "motor" : "body"))) {
            move.body = *body;
            if (check_target(node, parameter, move)) parameter.moves.push_back(std::move(move));
        }
    }

    void read_dimension(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::dimension;
        move.dimension = node["dimension"].string().value_or("");
        move.scale = read_scale(node, parameter, Dimension::length, context_.length_unit);
        move.offset = node["offset"].length(context_.length_unit).value_or(0);
    }

    void read_position(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::position;
        move.direction = node["position"].vector3().value_or(Vector3::UnitX());
        if (move.direction.norm() == 0) node["position"].fail(ErrorCode::out_of_range, "all coefficients are 0: this moves nothing");
        move.scale = read_scale(node, parameter, Dimension::length, context_.length_unit);
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
        move.scale = read_scale(node, parameter, Dimension::density, 1);
        move.offset = node["offset"].quantity(Dimension::density, 1).value_or(0);
    }

    void read_motor(const JsonNode& node, const Parameter& parameter, Move& move) {
        move.target = MoveTarget::motor_rate;
        const std::string name = node.require("rate").choice(dof_names).value_or("rz");
        move.dof = static_cast<int>(std::find(dof_names.begin(), dof_names.end(), name) - dof_names.begin());
        const Dimension dimension = move.dof >= 3 ? Dimension::angular_speed : Dimension::speed;
        const double unit = move.dof >= 3 ? to_si(1, *find_unit("deg/s")) : context_.length_unit;
        move.scale = read_scale(node, parameter, dimension, unit);
        move.offset = node["offset"].quantity(dimension, unit).value_or(0);
    }

    bool check_target(const JsonNode& node, const Parameter& parameter, const Move& move) {
        const core::scene::Body& body = context_.scene.bodies[static_cast<size_t>(move.body)];
        if (move.target == MoveTarget::dimension) return check_dimension(node["dimension"], body, move);
        if (move.target == MoveTarget::motor_rate && !body.prescribed[static_cast<size_t>(move.dof)]) {
            node["rate"].fail(ErrorCode::inconsistent, "body \"" + body.name + "\" has no motor on " + node["rate"].shown() +
                                                           "; give it one in the scene, under `prescribed`");
            return false;
        }
        if (move.target == MoveTarget::density && body.mass_kind != core::scene::MassKind::volume &&
            parameter.unit.dimension == Dimension::density) {
            node.fail(ErrorCode::inconsistent, "the density of body \"" + body.name + "\" is in " +
                                                   core::scene::density_unit(body.mass_kind) + " (its `mass_per`); give parameter \"" +
                                                   parameter.name + "\" the unit 1");
            return false;
        }
        return true;
    }

    bool check_dimension(const JsonNode& node, const core::scene::Body& body, const Move& move) {
        if (!body.shape) {
            node.fail(ErrorCode::inconsistent, "body \"" + body.name + "\" is a mesh from a file and has no dimensions; make it a `shape`");
            return false;
        }
        const auto& shape = shapes_[static_cast<size_t>(move.body)];
        if (!shape) {
            node.fail(ErrorCode::unsupported,
                      "body \"" + body.name +
                          "\" has a `scale` in the scene; a part that parameters move has none: give its dimensions their full size there");
            return false;
        }
        std::vector<std::string_view> known;
        for (const description::ShapeDimension& dimension : shape->dimensions()) known.push_back(dimension.name);
        if (std::find(known.begin(), known.end(), move.dimension) != known.end()) return true;
        node.fail(ErrorCode::out_of_range,
                  (body.shape->program ? "the program of body \"" + body.name : "generator \"" + body.shape->generator) +
                      "\" has no dimension " + node.shown() + "; " + core::files::did_you_mean(move.dimension, known));
        return false;
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
