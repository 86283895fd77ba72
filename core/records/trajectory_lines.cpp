// SPDX-License-Identifier: MIT
#include "core/records/trajectory_lines.hpp"

#include <string_view>
#include <utility>

#include "core/base/contract.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_writer.hpp"
#include "core/records/checkpoint_io.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/trajectory_format.hpp"

namespace fettle::core::records {
namespace {

using files::JsonWriter;
using kinematics::ChartPoint;
using kinematics::Pose;

std::size_t triangle_edge_count(const geometry::Mesh& mesh) {
    geometry::Mesh bare;
    bare.vertices = mesh.vertices;
    bare.triangles = mesh.triangles;
    geometry::build_connectivity(bare);
    return bare.edges.size();
}

void write_body(JsonWriter& out, const model::Body& body) {
    out.text += '{';
    out.key("name");
    out.string(body.name);
    out.key("type");
    out.string(body_type_names()[static_cast<std::size_t>(body.type)]);
    out.key("group");
    out.number(body.group);
    out.key("reference_point");
    out.numbers(body.reference_point);
    if (body.mass_kind != scene::MassKind::volume) {
        out.key("mass_per");
        out.string(mass_kind_names()[static_cast<std::size_t>(body.mass_kind)]);
        if (!body.mass_kind_given) {
            out.key("mass_per_given");
            out.text += "false";
        }
    }
    out.key("mesh");
    out.text += '{';
    out.key("name");
    out.string(body.mesh.name);
    out.key("vertices");
    out.numbers(body.mesh.vertices.reshaped());
    const auto whole = [&](int index) { out.text += std::to_string(index); };
    out.key("triangles");
    out.list(3 * body.mesh.triangles.size(), ",", [&](std::size_t i) { whole(body.mesh.triangles[i / 3][i % 3]); });
    const std::size_t first = triangle_edge_count(body.mesh);
    out.key("edges");
    out.list(2 * (body.mesh.edges.size() - first), ",", [&](std::size_t i) { whole(body.mesh.edges[first + i / 2][i % 2]); });
    out.text += "}}";
}

void write_poses(JsonWriter& out, const std::vector<Pose>& poses) {
    out.key("poses");
    out.list(poses.size(), ",", [&](std::size_t b) {
        const Pose& pose = poses[b];
        Eigen::Matrix<double, 12, 1> numbers;
        numbers << pose.rotation.row(0).transpose(), pose.rotation.row(1).transpose(), pose.rotation.row(2).transpose(), pose.position;
        out.numbers(numbers);
    });
}

void write_node(JsonWriter& out, const std::vector<ChartPoint>& node) {
    out.list(node.size(), ",", [&](std::size_t b) {
        Vector6 numbers;
        numbers << node[b].position, node[b].rotation_vector;
        out.numbers(numbers);
    });
}

void write_pairs(JsonWriter& out, const char* key, const std::vector<std::pair<int, int>>& pairs) {
    if (pairs.empty()) return;
    out.key(key);
    out.list(2 * pairs.size(), ",",
             [&](std::size_t i) { out.text += std::to_string(i % 2 == 0 ? pairs[i / 2].first : pairs[i / 2].second); });
}

// The writer breaks lines between keys; strings hold none.
std::string one_line(JsonWriter out) {
    std::erase(out.text, '\n');
    return std::move(out.text) + "}\n";
}

}  // namespace

TrajectoryLines::TrajectoryLines(const stepper::Trajectory& trajectory, const model::Model& model)
    : trajectory_(trajectory),
      model_(model),
      hash_(trajectory.timestep, trajectory.time_start, trajectory.times, trajectory.poses.front()) {
    FETTLE_ASSERT(trajectory.body_names.size() == model.bodies.size(), "a trajectory that is not of this model");
}

std::string TrajectoryLines::header(const std::string& scene_path) const {
    JsonWriter out;
    out.text = "{";
    out.key(format_key);
    out.number(format_version);
    out.key("scene");
    out.string(scene_path);
    out.key("geometry_hash");
    out.string(files::hexadecimal(geometry_hash(model_)));
    for (const auto& [name, value] : {std::pair{"length_unit", model_.length_unit},
                                      {"dhat", model_.dhat},
                                      {"dmin", model_.dmin},
                                      {"time_start", trajectory_.time_start},
                                      {"timestep", trajectory_.timestep}}) {
        out.key(name);
        out.number(value);
    }
    out.key("bodies");
    out.list(model_.bodies.size(), ",", [&](std::size_t b) { write_body(out, model_.bodies[b]); });
    write_pairs(out, "joined", model_.mechanism.not_colliding);
    write_pairs(out, "ignored", model_.ignored);
    if (!trajectory_.times.empty()) {
        out.key("time");
        out.number(trajectory_.times.front());
    }
    write_poses(out, trajectory_.poses.front());
    return one_line(std::move(out));
}

std::string TrajectoryLines::next_step() {
    const auto t = static_cast<std::size_t>(steps_++);
    FETTLE_ASSERT(t < trajectory_.steps.size() && t + 1 < trajectory_.poses.size(), "a step that is not there");
    const stepper::TrajectoryStep& step = trajectory_.steps[t];
    const double* time = trajectory_.times.empty() ? nullptr : &trajectory_.times[t + 1];
    hash_.add_step(step, time, trajectory_.poses[t + 1]);
    JsonWriter out;
    out.text = "{";
    out.key("nodes");
    out.list(step.nodes.size(), ",", [&](std::size_t k) { write_node(out, step.nodes[k]); });
    if (!step.fractions.empty()) {
        out.key("fractions");
        out.numbers(step.fractions);
    }
    if (time) {
        out.key("time");
        out.number(*time);
    }
    write_poses(out, trajectory_.poses[t + 1]);
    out.key("hash");
    out.string(files::hexadecimal(hash_.value()));
    return one_line(std::move(out));
}

std::string TrajectoryLines::checkpoint(const stepper::Checkpoint& checkpoint) const {
    JsonWriter out;
    out.text = "{";
    out.key("checkpoint");
    write_checkpoint(out, checkpoint, scene_parts(model_));
    return one_line(std::move(out));
}

}  // namespace fettle::core::records
