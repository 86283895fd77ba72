// SPDX-License-Identifier: MIT
#include "core/records/trajectory_header.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_keys.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/trajectory_format.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;
using files::JsonNode;
using kinematics::Pose;

constexpr files::NumberRange stored_lengths{0, 1e30, true};
constexpr double rotation_defect = 1e-14;  // what a rotation of ours, made orthonormal once, stays within

bool in_range(const std::vector<double>& numbers, const JsonNode& node) {
    for (const double x : numbers) {
        if (x >= stored_numbers.low && x <= stored_numbers.high) continue;
        node.fail(ErrorCode::out_of_range, "numbers beyond 1e30 are refused");
        return false;
    }
    return true;
}

std::vector<int> indices(const JsonNode& node, std::size_t columns, Eigen::Index limit) {
    const auto found = node.numbers().value_or(std::vector<double>{});
    if (found.size() % columns != 0) {
        node.fail(ErrorCode::inconsistent, "the number of indices is not a multiple of " + std::to_string(columns));
        return {};
    }
    std::vector<int> out;
    for (const double x : found) {
        if (x != std::floor(x) || x < 0 || x >= static_cast<double>(limit)) {
            node.fail(ErrorCode::out_of_range, "an index is not a whole number from 0 to " + std::to_string(limit - 1));
            return {};
        }
        out.push_back(static_cast<int>(x));
    }
    return out;
}

// Nothing can be said of a triangle or an edge whose corners are not distinct.
bool are_distinct(const std::vector<int>& list, std::size_t columns, const JsonNode& node) {
    for (std::size_t i = 0; i < list.size(); i += columns) {
        const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::set<int>(begin, begin + static_cast<std::ptrdiff_t>(columns)).size() == columns) continue;
        node.fail(ErrorCode::inconsistent, "entry " + std::to_string(i / columns) + " has the same vertex twice");
        return false;
    }
    return true;
}

void read_vertices(const JsonNode& node, geometry::Mesh& mesh) {
    auto coordinates = node.numbers().value_or(std::vector<double>{});
    if (coordinates.empty() || coordinates.size() % 3 != 0) node.fail(ErrorCode::inconsistent, "three coordinates per vertex are expected");
    if (coordinates.empty() || coordinates.size() % 3 != 0 || !in_range(coordinates, node)) return;
    mesh.vertices = Eigen::Map<const Matrix3X>(coordinates.data(), 3, coordinates.size() / 3);
}

model::Body read_body(const JsonNode& node) {
    model::Body body;
    node.allow_keys({"name", "type", "group", "reference_point", "mass_per", "mass_per_given", "mesh"});
    body.name = node.require("name").string().value_or("");
    if (const std::string fault = base::name_fault(body.name); !fault.empty())
        node["name"].fail(ErrorCode::out_of_range, "a name is text on one line; this one " + fault);
    const std::string type = node.require("type").choice(body_type_names()).value_or("dynamic");
    const auto& names = body_type_names();
    body.type = static_cast<scene::BodyType>(std::find(names.begin(), names.end(), type) - names.begin());
    const std::string kind = node["mass_per"].choice(mass_kind_names()).value_or("volume");
    const auto& kinds = mass_kind_names();
    body.mass_kind = static_cast<scene::MassKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
    body.mass_kind_given = node["mass_per_given"].boolean().value_or(true);
    body.group = node.require("group").integer(-1).value_or(-1);
    const auto reference = read_row(node.require("reference_point"), 3, "x y z");
    if (!reference.empty()) body.reference_point = Vector3(reference[0], reference[1], reference[2]);
    const JsonNode mesh = node.require("mesh");
    mesh.allow_keys({"name", "vertices", "triangles", "edges"});
    body.mesh.name = mesh.require("name").string().value_or("");
    read_vertices(mesh.require("vertices"), body.mesh);
    const auto corners = indices(mesh.require("triangles"), 3, body.mesh.vertices.cols());
    const auto ends = indices(mesh.require("edges"), 2, body.mesh.vertices.cols());
    if (!are_distinct(corners, 3, mesh["triangles"]) || !are_distinct(ends, 2, mesh["edges"])) return body;
    for (std::size_t i = 0; i < corners.size(); i += 3) body.mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    std::vector<geometry::Edge> edges;
    for (std::size_t i = 0; i < ends.size(); i += 2) edges.push_back({ends[i], ends[i + 1]});
    geometry::build_connectivity(body.mesh, edges);
    return body;
}

Pose read_pose(const JsonNode& node) {
    const auto numbers = read_row(node, 12, "a rotation row by row, and a position");
    Pose pose;
    if (numbers.empty()) return pose;
    for (std::size_t i = 0; i < 9; ++i) pose.rotation(i / 3, i % 3) = numbers[i];
    pose.position = Vector3(numbers[9], numbers[10], numbers[11]);
    const double defect = (pose.rotation.transpose() * pose.rotation - Matrix3::Identity()).cwiseAbs().maxCoeff();
    if (!(defect <= rotation_defect) || !(pose.rotation.determinant() > 0))
        node.fail(ErrorCode::out_of_range, "the first nine numbers are not a rotation matrix (to 1e-14)");
    return pose;
}

// Bodies that do not collide.
std::vector<std::pair<int, int>> read_pairs(const JsonNode& node, std::size_t bodies) {
    const std::vector<int> numbers = indices(node, 2, bodies);
    std::vector<std::pair<int, int>> pairs;
    for (std::size_t i = 0; i < numbers.size(); i += 2) pairs.emplace_back(std::minmax(numbers[i], numbers[i + 1]));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

void read_settings(const JsonNode& root, StoredTrajectory& out) {
    out.scene_path = root["scene"].string().value_or("");
    out.model.length_unit = root.require("length_unit").number(stored_lengths).value_or(1);
    out.model.dhat = root.require("dhat").number(stored_lengths).value_or(1);
    out.model.dmin = root.require("dmin").number({0, 1e30, false}).value_or(0);
    out.trajectory.time_start = root.require("time_start").number(stored_numbers).value_or(0);
    out.model.timestep = out.trajectory.timestep = root.require("timestep").number(stored_lengths).value_or(1);
    if (const auto time = root["time"].number(stored_numbers)) out.trajectory.times.push_back(*time);
}

}  // namespace

bool has_entries(const std::vector<JsonNode>& list, std::size_t count, const JsonNode& node, const char* what) {
    if (list.size() == count) return true;
    if (node.is_array())
        node.fail(ErrorCode::inconsistent, std::to_string(list.size()) + " entries, " + std::to_string(count) + " expected: " + what);
    return false;
}

std::vector<double> read_row(const JsonNode& node, std::size_t count, const char* what) {
    const auto numbers = node.numbers();
    if (!numbers) return {};
    if (numbers->size() != count) node.fail(ErrorCode::inconsistent, std::to_string(count) + " numbers are expected: " + what);
    if (numbers->size() != count || !in_range(*numbers, node)) return {};
    return *numbers;
}

std::vector<Pose> read_pose_list(const JsonNode& node, std::size_t count) {
    const auto entries = node.elements();
    std::vector<Pose> poses;
    if (has_entries(entries, count, node, "one pose per body"))
        for (const JsonNode& entry : entries) poses.push_back(read_pose(entry));
    return poses;
}

void read_trajectory_header(const JsonNode& root, StoredTrajectory& out) {
    root.allow_keys({format_key, "scene", "geometry_hash", "length_unit", "dhat", "dmin", "time_start", "timestep", "bodies", "joined",
                     "ignored", "time", "poses"});
    if (!files::is_version(root.require(format_key), format_version)) return;
    read_settings(root, out);
    const JsonNode bodies = root.require("bodies");
    for (const JsonNode& node : bodies.elements()) {
        out.model.bodies.push_back(read_body(node));
        out.trajectory.body_names.push_back(out.model.bodies.back().name);
    }
    if (std::set<std::string>(out.trajectory.body_names.begin(), out.trajectory.body_names.end()).size() < out.model.bodies.size())
        bodies.fail(ErrorCode::inconsistent, "two bodies have the same name");
    out.model.mechanism.not_colliding = read_pairs(root["joined"], out.model.bodies.size());
    out.model.ignored = read_pairs(root["ignored"], out.model.bodies.size());
    out.trajectory.poses.push_back(read_pose_list(root.require("poses"), out.model.bodies.size()));
    if (out.trajectory.poses[0].size() != out.model.bodies.size()) return;
    for (std::size_t b = 0; b < out.model.bodies.size(); ++b) out.model.bodies[b].pose_start = out.trajectory.poses[0][b];
    const auto stored = root.require("geometry_hash").string();
    const std::string found = files::hexadecimal(geometry_hash(out.model));
    if (stored && *stored != found)
        root["geometry_hash"].fail(ErrorCode::inconsistent,
                                   "the meshes are not those that the trajectory was written with (" + found + "): the file was changed");
}

}  // namespace fettle::core::records
