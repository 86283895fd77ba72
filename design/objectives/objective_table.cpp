// SPDX-License-Identifier: MIT
#include "fettle/design/objectives/objective_table.hpp"

#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/objectives/marker_path.hpp"
#include "fettle/design/objectives/mass.hpp"
#include "fettle/design/objectives/play.hpp"
#include "fettle/design/objectives/stroke.hpp"

namespace fettle::design::objectives {

namespace {

using core::files::JsonNode;

// For default names only: a wrong type is reported by the reading proper.
std::string text(const JsonNode& node) { return node.is_string() ? *node.string() : std::string("?"); }

std::unique_ptr<Objective> read_stroke(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto axis = context.axis(node.require("axis"));
    const auto target = node["target"].length(context.length_unit, core::files::not_negative);
    if (!body || !axis) return nullptr;
    return std::make_unique<Stroke>(*body, *axis, target);
}

std::vector<Vector3> read_points(const JsonNode& node, double unit) {
    std::vector<Vector3> points;
    for (const JsonNode& entry : node.elements()) {
        if (const auto point = entry.length3(unit)) points.push_back(*point);
    }
    if (node.is_array() && points.empty()) node.fail(ErrorCode::out_of_range, "a path needs a point");
    return points;
}

std::vector<double> read_times(const JsonNode& node, size_t points, double end_time) {
    std::vector<double> times;
    for (const JsonNode& entry : node.elements()) {
        if (const auto time = entry.number({0, end_time, false})) times.push_back(*time);
    }
    if (node.is_array() && node.elements().size() != points) {
        node.fail(ErrorCode::inconsistent,
                  "a path has one time for each of its " + std::to_string(points) + " points, or no `times` (free timing)");
    }
    return times;
}

std::unique_ptr<Objective> read_marker_path(const JsonNode& node, const ReadContext& context) {
    const auto body = context.body(node.require("body"));
    const auto point = node.require("point").length3(context.length_unit);
    const std::vector<Vector3> targets = read_points(node.require("points"), context.length_unit);
    const std::vector<double> times = read_times(node["times"], targets.size(), context.end_time);
    if (!body || !point || targets.empty() || (!times.empty() && times.size() != targets.size())) return nullptr;
    return std::make_unique<MarkerPath>(*body, *point, targets, times);
}

std::unique_ptr<Objective> read_play(const JsonNode& node, const ReadContext& context) {
    const auto a = context.body(node.require("a")), b = context.body(node.require("b"));
    if (!a || !b) return nullptr;
    if (*a == *b) {
        node.fail(ErrorCode::inconsistent, "a fit is between two bodies; `a` and `b` are the same");
        return nullptr;
    }
    return std::make_unique<Play>(*a, *b);
}

bool is_closed(const core::geometry::Mesh& mesh) { return !mesh.triangles.empty() && 2 * mesh.edges.size() == 3 * mesh.triangles.size(); }

std::unique_ptr<Objective> read_mass(const JsonNode& node, const ReadContext& context) {
    std::vector<int> bodies;
    const JsonNode list = node.require("bodies");
    for (const JsonNode& entry : list.elements()) {
        const auto body = context.body(entry);
        if (!body) continue;
        bodies.push_back(*body);
        if (!context.scene.bodies[static_cast<size_t>(*body)].density_given)
            entry.fail(ErrorCode::missing_key,
                       "body " + entry.shown() + " has no density in its scene, so it has no mass; give it a `density`");
        if (!is_closed(context.scene.bodies[static_cast<size_t>(*body)].mesh)) {
            entry.fail(ErrorCode::mesh_invalid,
                       "the mesh of body " + entry.shown() + " is open, so it has no volume and no mass by density");
        }
    }
    if (list.is_array() && bodies.empty()) list.fail(ErrorCode::out_of_range, "the mass of no body; name at least one");
    return std::make_unique<Mass>(bodies);
}

std::string stroke_name(const JsonNode& node) { return "stroke " + text(node["body"]); }
std::string marker_name(const JsonNode& node) { return "marker_path " + text(node["body"]); }
std::string play_name(const JsonNode& node) { return "play " + text(node["a"]) + ":" + text(node["b"]); }
std::string mass_name(const JsonNode& node) {
    std::string name = "mass";
    if (!node["bodies"].is_array()) return name;
    for (const JsonNode& body : node["bodies"].elements()) name += (name == "mass" ? " " : "+") + text(body);
    return name;
}

}  // namespace

const std::vector<ObjectiveType>& objective_table() {
    static const std::vector<ObjectiveType> table{{"stroke", {"body", "axis", "target"}, read_stroke, stroke_name},
                                                  {"marker_path", {"body", "point", "points", "times"}, read_marker_path, marker_name},
                                                  {"play", {"a", "b"}, read_play, play_name},
                                                  {"mass", {"bodies"}, read_mass, mass_name}};
    return table;
}

const ObjectiveType* find_objective_type(std::string_view name) {
    for (const ObjectiveType& type : objective_table()) {
        if (type.name == name) return &type;
    }
    return nullptr;
}

std::optional<int> ReadContext::body(const JsonNode& node) const {
    const auto name = node.string();
    if (!name) return std::nullopt;
    std::vector<std::string_view> known;
    for (size_t k = 0; k < scene.bodies.size(); ++k) {
        if (scene.bodies[k].name == *name) return static_cast<int>(k);
        known.push_back(scene.bodies[k].name);
    }
    node.fail(ErrorCode::out_of_range, "the scene has no body " + node.shown() + "; " + core::files::did_you_mean(*name, known));
    return std::nullopt;
}

std::optional<Vector3> ReadContext::axis(const JsonNode& node) const {
    const auto vector = node.vector3();
    if (!vector) return std::nullopt;
    if (vector->norm() == 0) {
        node.fail(ErrorCode::out_of_range, "an axis is not the zero vector");
        return std::nullopt;
    }
    return vector->normalized();
}

}  // namespace fettle::design::objectives
