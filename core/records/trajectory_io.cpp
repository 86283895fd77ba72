// SPDX-License-Identifier: MIT
#include "fettle/core/records/trajectory_io.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/files/json_document.hpp"
#include "fettle/core/files/json_keys.hpp"
#include "fettle/core/files/json_writer.hpp"
#include "fettle/core/model/build_model.hpp"
#include "fettle/core/records/checkpoint_io.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;
using files::JsonDocument;
using files::JsonNode;
using files::JsonWriter;
using kinematics::ChartPoint;
using kinematics::Pose;

const std::vector<std::string_view> type_names{"dynamic", "static", "kinematic"};  // in the order of scene::BodyType

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
    out.string(type_names[static_cast<std::size_t>(body.type)]);
    out.key("group");
    out.number(body.group);
    out.key("reference_point");
    out.numbers(body.reference_point);
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

void write_pose(JsonWriter& out, const Pose& pose) {
    Eigen::Matrix<double, 12, 1> numbers;
    numbers << pose.rotation.row(0).transpose(), pose.rotation.row(1).transpose(), pose.rotation.row(2).transpose(), pose.position;
    out.numbers(numbers);
}

void write_node(JsonWriter& out, const ChartPoint& node) {
    Vector6 numbers;
    numbers << node.position, node.rotation_vector;
    out.numbers(numbers);
}

class Reader {
public:
    explicit Reader(JsonDocument& document) : document_(document) {}

    base::Result<StoredTrajectory> read() {
        const JsonNode root = document_.root();
        root.allow_keys({"fettle_trajectory", "scene", "geometry_hash", "length_unit", "dhat", "dmin", "time_start", "timestep", "times",
                         "bodies", "poses", "steps", "checkpoint"});
        root.require("fettle_trajectory").integer(1, 1);
        if (!document_.errors().empty()) return document_.errors();
        out_.path = document_.path();
        out_.scene_path = root["scene"].string().value_or("");
        out_.model.length_unit = root.require("length_unit").number(files::positive).value_or(1);
        out_.model.dhat = root.require("dhat").number(files::positive).value_or(1);
        out_.model.dmin = root.require("dmin").number(files::not_negative).value_or(0);
        out_.trajectory.time_start = root.require("time_start").number().value_or(0);
        out_.model.timestep = out_.trajectory.timestep = root.require("timestep").number(files::positive).value_or(1);
        for (const JsonNode& body : root.require("bodies").elements()) read_body(body);
        read_poses(root.require("poses"));
        if (root["times"].exists()) read_times(root["times"]);
        read_steps(root.require("steps"));
        if (!document_.errors().empty()) return document_.errors();
        check_path(root);
        if (root["checkpoint"].exists()) out_.checkpoint = read_checkpoint(root["checkpoint"], out_.trajectory);
        finish_model(root.require("geometry_hash"));
        if (!document_.errors().empty()) return document_.errors();
        return std::move(out_);
    }

private:
    std::size_t body_count() const { return out_.model.bodies.size(); }

    /// `list` has `count` entries, or a fault.
    bool has_entries(const std::vector<JsonNode>& list, std::size_t count, const JsonNode& node, const char* what) {
        if (list.size() == count) return true;
        if (node.is_array()) {
            node.fail(ErrorCode::inconsistent, std::to_string(list.size()) + " entries, " + std::to_string(count) + " wanted: " + what);
        }
        return false;
    }

    std::vector<int> indices(const JsonNode& node, std::size_t columns, Eigen::Index limit) {
        std::vector<int> out;
        const auto found = node.numbers().value_or(std::vector<double>{});
        if (found.size() % columns != 0)
            node.fail(ErrorCode::inconsistent, "the number of indices is not a multiple of " + std::to_string(columns));
        for (const double x : found) {
            if (x != std::floor(x) || x < 0 || x >= static_cast<double>(limit)) {
                node.fail(ErrorCode::out_of_range, "an index is not a whole number from 0 to " + std::to_string(limit - 1));
                return {};
            }
            out.push_back(static_cast<int>(x));
        }
        if (found.size() % columns != 0) out.clear();
        return out;
    }

    void read_body(const JsonNode& node) {
        model::Body body;
        body.name = node.require("name").string().value_or("");
        const std::string type = node.require("type").choice(type_names).value_or("dynamic");
        body.type = type == "static"      ? scene::BodyType::static_body
                    : type == "kinematic" ? scene::BodyType::kinematic_body
                                          : scene::BodyType::dynamic_body;
        body.group = node.require("group").integer(-1).value_or(-1);
        body.reference_point = node.require("reference_point").vector3().value_or(Vector3::Zero());
        const JsonNode mesh = node.require("mesh");
        body.mesh.name = mesh.require("name").string().value_or("");
        const auto coordinates = mesh.require("vertices").numbers().value_or(std::vector<double>{});
        if (coordinates.empty() || coordinates.size() % 3 != 0)
            mesh["vertices"].fail(ErrorCode::inconsistent, "three coordinates per vertex are wanted");
        body.mesh.vertices.resize(3, static_cast<Eigen::Index>(coordinates.size() / 3));
        for (Eigen::Index i = 0; i < body.mesh.vertices.size(); ++i)
            body.mesh.vertices.reshaped()[i] = coordinates[static_cast<std::size_t>(i)];
        const auto corners = indices(mesh.require("triangles"), 3, body.mesh.vertices.cols());
        for (std::size_t i = 0; i < corners.size(); i += 3) body.mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        std::vector<geometry::Edge> edges;
        const auto ends = indices(mesh.require("edges"), 2, body.mesh.vertices.cols());
        for (std::size_t i = 0; i < ends.size(); i += 2) edges.push_back({ends[i], ends[i + 1]});
        geometry::build_connectivity(body.mesh, edges);
        out_.trajectory.body_names.push_back(body.name);
        out_.model.bodies.push_back(std::move(body));
    }

    void read_poses(const JsonNode& node) {
        for (const JsonNode& instant : node.elements()) {
            std::vector<Pose> poses;
            const auto entries = instant.elements();
            if (!has_entries(entries, body_count(), instant, "one pose per body")) continue;
            for (const JsonNode& entry : entries) poses.push_back(read_pose(entry));
            out_.trajectory.poses.push_back(std::move(poses));
        }
        if (node.is_array() && out_.trajectory.poses.empty()) node.fail(ErrorCode::inconsistent, "the start pose is missing");
    }

    void read_times(const JsonNode& node) {
        const auto times = node.numbers().value_or(std::vector<double>{});
        const bool as_many = times.size() == out_.trajectory.poses.size();
        if (!as_many || std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
            node.fail(ErrorCode::inconsistent, "one time per entry of `poses` is wanted, each later than the one before");
        out_.trajectory.times = times;
    }

    Pose read_pose(const JsonNode& node) {
        const auto numbers = node.numbers();
        if (!numbers || numbers->size() != 12) {
            if (numbers) node.fail(ErrorCode::inconsistent, "12 numbers are wanted: a rotation row by row, and a position");
            return {};
        }
        Pose pose;
        for (int i = 0; i < 9; ++i) pose.rotation(i / 3, i % 3) = (*numbers)[static_cast<std::size_t>(i)];
        for (int i = 0; i < 3; ++i) pose.position[i] = (*numbers)[static_cast<std::size_t>(9 + i)];
        const double defect = (pose.rotation.transpose() * pose.rotation - Matrix3::Identity()).cwiseAbs().maxCoeff();
        if (!(defect <= 1e-9) || !(pose.rotation.determinant() > 0))
            node.fail(ErrorCode::out_of_range, "the first nine numbers are not a rotation matrix");
        return pose;
    }

    void read_steps(const JsonNode& node) {
        const auto steps = node.elements();
        const std::size_t poses = out_.trajectory.poses.size();
        if (poses > 0) has_entries(steps, poses - 1, node, "one step between each two poses");
        for (const JsonNode& step : steps) {
            stepper::TrajectoryStep read;
            for (const JsonNode& node_of_step : step.elements()) read.nodes.push_back(read_node(node_of_step));
            if (step.is_array() && read.nodes.size() < 2) step.fail(ErrorCode::inconsistent, "a step has at least two nodes");
            out_.trajectory.steps.push_back(std::move(read));
        }
    }

    std::vector<ChartPoint> read_node(const JsonNode& node) {
        const auto entries = node.elements();
        std::vector<ChartPoint> points(body_count());
        if (!has_entries(entries, body_count(), node, "six numbers per body")) return points;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const auto numbers = entries[i].numbers();
            if (!numbers || numbers->size() != 6) {
                if (numbers) entries[i].fail(ErrorCode::inconsistent, "six numbers are wanted: px py pz rx ry rz");
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                points[i].position[k] = (*numbers)[static_cast<std::size_t>(k)];
                points[i].rotation_vector[k] = (*numbers)[static_cast<std::size_t>(3 + k)];
            }
        }
        return points;
    }

    /// A certificate is about the path as stored: it must be one path, without jumps from step to step.
    void check_path(const JsonNode& root) {
        const stepper::Trajectory& trajectory = out_.trajectory;
        const auto steps = root["steps"].elements();
        for (std::size_t t = 0; t < trajectory.steps.size(); ++t) {
            const auto &first = trajectory.steps[t].nodes.front(), &last = trajectory.steps[t].nodes.back();
            for (std::size_t b = 0; b < body_count(); ++b) {
                const Pose &before = trajectory.poses[t][b], &after = trajectory.poses[t + 1][b];
                const Matrix3X& vertices = out_.model.bodies[b].mesh.vertices;
                const double allowed = 1e-9 * (vertices.cwiseAbs().maxCoeff() + before.position.norm() + after.position.norm());
                const Matrix3 reached = kinematics::rotation(last[b].rotation_vector) * before.rotation;
                const bool starts = first[b].rotation_vector == Vector3::Zero() && (first[b].position - before.position).norm() <= allowed;
                const bool ends =
                    (last[b].position - after.position).norm() <= allowed && (reached - after.rotation).cwiseAbs().maxCoeff() <= 1e-9;
                if (starts && ends) continue;
                steps[t].fail(ErrorCode::inconsistent, "the path of body `" + trajectory.body_names[b] + "` does not " +
                                                           (starts ? "end at the next pose" : "start at its pose with rotation vector 0"));
            }
        }
    }

    void finish_model(const JsonNode& hash) {
        for (std::size_t b = 0; b < body_count(); ++b) out_.model.bodies[b].pose_start = out_.trajectory.poses[0][b];
        model::complete_geometry(out_.model.bodies);
        out_.model.end_time = stepper::time_at(out_.trajectory, static_cast<int>(out_.trajectory.steps.size()));
        const auto stored = hash.string();
        const std::string found = files::hexadecimal(geometry_hash(out_.model));
        if (stored && *stored != found) {
            hash.fail(ErrorCode::inconsistent,
                      "the meshes are not those that the trajectory was written with (" + found + "): the file was changed");
        }
    }

    JsonDocument& document_;
    StoredTrajectory out_;
};

}  // namespace

std::uint64_t geometry_hash(const model::Model& model) {
    files::Fnv1a hash;
    for (const model::Body& body : model.bodies) {
        hash.add(static_cast<std::uint64_t>(body.name.size()));
        hash.add(body.name);
        hash.add(static_cast<std::uint64_t>(body.mesh.vertices.cols()));
        for (const double x : body.mesh.vertices.reshaped()) hash.add(x);
        hash.add(static_cast<std::uint64_t>(body.mesh.triangles.size()));
        for (const auto& triangle : body.mesh.triangles) {
            for (const int v : triangle) hash.add(static_cast<std::uint32_t>(v));
        }
        hash.add(static_cast<std::uint64_t>(body.mesh.edges.size()));
        for (const auto& edge : body.mesh.edges) {
            for (const int v : edge) hash.add(static_cast<std::uint32_t>(v));
        }
    }
    return hash.value();
}

std::uint64_t path_hash(const stepper::Trajectory& trajectory) {
    files::Fnv1a hash;
    const auto add = [&](const Vector3& v) {
        for (const double x : v) hash.add(x);
    };
    hash.add(trajectory.timestep);
    hash.add(trajectory.time_start);
    for (const double time : trajectory.times) hash.add(time);
    for (const auto& poses : trajectory.poses) {
        for (const kinematics::Pose& pose : poses) {
            for (int row = 0; row < 3; ++row) add(pose.rotation.row(row));
            add(pose.position);
        }
    }
    for (const stepper::TrajectoryStep& step : trajectory.steps) {
        hash.add(static_cast<std::uint64_t>(step.nodes.size()));
        for (const auto& node : step.nodes) {
            for (const kinematics::ChartPoint& point : node) {
                add(point.position);
                add(point.rotation_vector);
            }
        }
    }
    return hash.value();
}

base::Errors write_trajectory(const std::filesystem::path& path, const stepper::Trajectory& trajectory, const model::Model& model,
                              const std::string& scene_path, const stepper::Checkpoint* checkpoint) {
    FETTLE_ASSERT(trajectory.body_names.size() == model.bodies.size() && trajectory.poses.size() == trajectory.steps.size() + 1,
                  "a trajectory that is not of this model");
    JsonWriter out;
    out.text = "{";
    out.key("fettle_trajectory");
    out.number(1);
    out.key("scene");
    out.string(scene_path);
    out.key("geometry_hash");
    out.string(files::hexadecimal(geometry_hash(model)));
    for (const auto& [name, value] : {std::pair{"length_unit", model.length_unit},
                                      {"dhat", model.dhat},
                                      {"dmin", model.dmin},
                                      {"time_start", trajectory.time_start},
                                      {"timestep", trajectory.timestep}}) {
        out.key(name);
        out.number(value);
    }
    if (!trajectory.times.empty()) {
        out.key("times");
        out.list(trajectory.times.size(), ",", [&](std::size_t t) { out.number(trajectory.times[t]); });
    }
    out.key("bodies");
    out.list(model.bodies.size(), ",\n  ", [&](std::size_t b) { write_body(out, model.bodies[b]); });
    out.key("poses");
    out.list(trajectory.poses.size(), ",\n  ",
             [&](std::size_t t) { out.list(model.bodies.size(), ",", [&](std::size_t b) { write_pose(out, trajectory.poses[t][b]); }); });
    out.key("steps");
    out.list(trajectory.steps.size(), ",\n  ", [&](std::size_t t) {
        const auto& nodes = trajectory.steps[t].nodes;
        out.list(nodes.size(), ",",
                 [&](std::size_t k) { out.list(model.bodies.size(), ",", [&](std::size_t b) { write_node(out, nodes[k][b]); }); });
    });
    if (checkpoint) {
        out.key("checkpoint");
        write_checkpoint(out, *checkpoint);
    }
    out.text += "}\n";
    return files::write_file_atomically(path, out.text);
}

base::Result<stepper::Simulation> resumable(const StoredTrajectory& stored, const model::Model& model) {
    const auto refuse = [&](const std::string& why) {
        return base::Error{ErrorCode::inconsistent, stored.path, "cannot be continued: " + why};
    };
    if (!stored.checkpoint) return refuse("it holds no checkpoint; trajectories that fettle stepper::simulate writes do");
    if (geometry_hash(stored.model) != geometry_hash(model)) return refuse("its bodies or meshes are not those of the scene");
    if (stored.trajectory.timestep != model.timestep)
        return refuse("its time step is " + std::to_string(stored.trajectory.timestep) + " s, the scene's " +
                      std::to_string(model.timestep) + " s");
    const energy::History wanted = energy::start_history(model), &found = stored.checkpoint->state.history;
    const bool bdf2 = model.integrator == scene::Integrator::bdf2 && stored.checkpoint->step > 0;
    if (found.accelerations.size() != wanted.accelerations.size() || found.poses_before.empty() == bdf2)
        return refuse("it was computed with another integrator");
    stepper::Simulation out;
    out.trajectory = stored.trajectory;
    out.checkpoint = *stored.checkpoint;
    return out;
}

bool is_trajectory_file(const std::filesystem::path& path) { return files::has_top_level_key(path, "fettle_trajectory"); }

base::Result<StoredTrajectory> read_trajectory(const std::filesystem::path& path) {
    auto document = JsonDocument::read(path.string());
    if (!document) return document.errors();
    return Reader(*document).read();
}

}  // namespace fettle::core::records
