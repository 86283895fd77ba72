// SPDX-License-Identifier: MIT
#include "design/report/moving_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/geometry/mesh.hpp"
#include "design/exports/palette.hpp"
#include "design/report/answer_values.hpp"
#include "design/report/packed_numbers.hpp"

namespace fettle::design::report {

namespace {

using Json = nlohmann::ordered_json;
using core::kinematics::Pose;
using core::stepper::Trajectory;

// Those edges that no triangle has: they follow the triangles' own.
std::vector<std::uint32_t> loose_edges(const core::geometry::Mesh& mesh) {
    std::set<std::array<int, 2>> sides;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) sides.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::vector<std::uint32_t> ends;
    for (const auto& [a, b] : mesh.edges) {
        if (sides.count({std::min(a, b), std::max(a, b)}) > 0) continue;
        ends.push_back(static_cast<std::uint32_t>(a));
        ends.push_back(static_cast<std::uint32_t>(b));
    }
    return ends;
}

Json mesh_json(const core::geometry::Mesh& mesh) {
    std::vector<float> vertices;
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
        for (Eigen::Index k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(mesh.vertices(k, v) / millimetre));
    std::vector<std::uint32_t> triangles;
    for (const auto& t : mesh.triangles)
        for (const int v : t) triangles.push_back(static_cast<std::uint32_t>(v));
    return {{"vertices", packed(vertices)}, {"triangles", packed(triangles)}, {"edges", packed(loose_edges(mesh))}};
}

// A node of the path: of step -1 the start.
struct Node {
    int step = -1, node = 0;
};

// All nodes but those that are the end of the step before, each `every`th step's.
std::vector<Node> nodes_of(const Trajectory& trajectory, int every) {
    std::vector<Node> nodes{{}};
    const auto steps = count_of(trajectory.steps);
    for (int t = 0; t < steps; ++t) {
        const int count = core::stepper::segment_count(trajectory, t);
        if ((t + 1) % every != 0 && t + 1 != steps) continue;
        for (int k = every == 1 ? 1 : count; k <= count; ++k) nodes.push_back({t, k});
    }
    return nodes;
}

Pose pose_of(const Trajectory& trajectory, const Node& node, int body) {
    if (node.step < 0) return trajectory.poses.front()[body];
    if (node.node == core::stepper::segment_count(trajectory, node.step)) return trajectory.poses[static_cast<size_t>(node.step) + 1][body];
    return core::stepper::pose_at(trajectory, node.step, node.node, 0, body);
}

double time_of(const Trajectory& trajectory, const Node& node) {
    return node.step < 0 ? core::stepper::time_at(trajectory, 0) : core::stepper::time_at(trajectory, node.step, node.node - 1, 1);
}

bool moves(const Trajectory& trajectory, std::size_t body) {
    const Pose& first = trajectory.poses.front()[body];
    return std::any_of(trajectory.poses.begin(), trajectory.poses.end(),
                       [&](const auto& poses) { return poses[body].position != first.position || poses[body].rotation != first.rotation; });
}

const char* word(core::scene::BodyType type) {
    switch (type) {
        case core::scene::BodyType::static_body:
            return "static";
        case core::scene::BodyType::kinematic_body:
            return "kinematic";
        case core::scene::BodyType::dynamic_body:
            break;
    }
    return "dynamic";
}

}  // namespace

void append_pose(std::vector<float>& numbers, const Pose& pose) {
    Eigen::Quaterniond q(pose.rotation);
    q.normalize();
    if (numbers.size() >= 7) {
        const float* before = &numbers[numbers.size() - 4];
        const double dot = q.x() * before[0] + q.y() * before[1] + q.z() * before[2] + q.w() * before[3];
        if (dot < 0) q.coeffs() = -q.coeffs();
    }
    for (const double x :
         {pose.position.x() / millimetre, pose.position.y() / millimetre, pose.position.z() / millimetre, q.x(), q.y(), q.z(), q.w()})
        numbers.push_back(static_cast<float>(x));
}

void add_view(Json& data, const std::string& name, const core::model::Model& model, const Trajectory& trajectory) {
    const std::size_t all = std::max<std::size_t>(1, model.bodies.size() * trajectory.poses.size());
    const auto every = static_cast<int>((all + most_poses - 1) / most_poses);
    const std::vector<Node> nodes = nodes_of(trajectory, every);
    std::vector<double> times;
    for (const Node& node : nodes) times.push_back(time_of(trajectory, node));
    if (!data.contains("meshes")) data["meshes"] = Json::array();
    std::vector<const core::geometry::Mesh*> meshes;
    for (const core::model::Body& body : model.bodies) meshes.push_back(&body.mesh);
    const std::vector<std::size_t> shapes = core::geometry::first_of_shape(meshes);
    std::vector<std::size_t> mesh_of_first;  // where the first mesh of a shape went
    const std::vector<exports::Colour> colours = exports::part_colours(model);
    Json bodies = Json::array();
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const core::model::Body& body = model.bodies[i];
        const std::size_t first = shapes[i];
        mesh_of_first.push_back(data["meshes"].size());
        if (first == i) data["meshes"].push_back(mesh_json(body.mesh));
        std::vector<float> poses;
        if (moves(trajectory, i)) {
            poses.reserve(7 * nodes.size());
            for (const Node& node : nodes) append_pose(poses, pose_of(trajectory, node, static_cast<int>(i)));
        } else {
            append_pose(poses, trajectory.poses.front()[i]);
        }
        bodies.push_back({{"name", body.name},
                          {"type", word(body.type)},
                          {"colour", exports::css_colour(colours[i])},
                          {"mesh", mesh_of_first[first]},
                          {"poses", packed(poses)}});
    }
    data["views"].push_back({{"name", name}, {"every", every}, {"times", packed(times)}, {"bodies", std::move(bodies)}});
}

}  // namespace fettle::design::report
