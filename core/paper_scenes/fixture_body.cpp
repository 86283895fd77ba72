// SPDX-License-Identifier: MIT
#include "core/paper_scenes/fixture_body.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/files/index_rows.hpp"
#include "core/geometry/half_edges.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/geometry/mesh_transforms.hpp"
#include "core/mesh_files/find_mesh_file.hpp"
#include "core/mesh_files/mesh_reader.hpp"
#include "core/paper_scenes/fixture_state.hpp"
#include "core/scene/angles.hpp"
#include "core/scene/mass_kind.hpp"
#include "core/solids/mesh_validity.hpp"
#include "core/solids/shells.hpp"

namespace fettle::core::paper_scenes {
namespace {

using base::ErrorCode;

const std::vector<std::string_view> fixture_body_keys{"mesh",
                                                      "vertices",
                                                      "edges",
                                                      "faces",
                                                      "density",
                                                      "enabled",
                                                      "type",
                                                      "is_dof_fixed",
                                                      "position",
                                                      "rotation",
                                                      "scale",
                                                      "dimensions",
                                                      "linear_velocity",
                                                      "angular_velocity",
                                                      "force",
                                                      "torque",
                                                      "group_id",
                                                      "oriented",
                                                      "split_components",
                                                      "kinematic_max_time",
                                                      "kinematic_poses",
                                                      "ipc_comparison_enabled"};

constexpr const char* no_2d = "2D scenes are not supported";

Vector3 scale_factors(const files::JsonNode& node, const geometry::Mesh& mesh) {
    const files::JsonNode scale = node["scale"].unless_null(), dimensions = node["dimensions"].unless_null();
    if (dimensions.exists()) {
        const Vector3 extent = geometry::box_sides(mesh.vertices);
        Vector3 factors = fixture_vector(dimensions).value_or(Vector3::Ones());
        for (int i = 0; i < 3; ++i) factors[i] /= extent[i] == 0 ? 1 : extent[i];
        return factors;
    }
    if (scale.is_array()) return fixture_vector(scale).value_or(Vector3::Ones());
    return Vector3::Constant(scale.number().value_or(1));
}

std::array<bool, 6> fixed_dofs(const files::JsonNode& node) {
    std::array<bool, 6> fixed{};
    if (node.is_bool()) {
        fixed.fill(node.boolean().value_or(false));
        return fixed;
    }
    const auto entries = node.elements();
    if (entries.size() == 3) {
        node.fail(ErrorCode::unsupported, no_2d);
    } else if (node.exists() && node.is_array() && entries.size() != 6) {
        node.fail(ErrorCode::wrong_type, "a list of six (px py pz rx ry rz) is expected, found " + node.shown());
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(6, entries.size()); ++i) fixed[i] = entries[i].boolean().value_or(false);
    return fixed;
}

scene::BodyType body_type(const files::JsonNode& node, const std::array<bool, 6>& fixed) {
    const std::string type = node.string().value_or("dynamic");
    if (type != "static" && type != "kinematic" && type != "dynamic") node.warn("unknown type " + node.shown() + " means static");
    const bool held = std::all_of(fixed.begin(), fixed.end(), [](bool f) { return f; });
    if (held || (type != "dynamic" && type != "kinematic")) return scene::BodyType::static_body;
    return type == "kinematic" ? scene::BodyType::kinematic_body : scene::BodyType::dynamic_body;
}

MeshMass look_at_mass(const geometry::Mesh& mesh) {
    if (mesh.triangles.empty()) return {mesh.edges.empty() ? scene::MassKind::vertex : scene::MassKind::length};
    const std::vector<geometry::HalfEdge> halves = geometry::sorted_half_edges(mesh);
    const std::vector<geometry::Opening> openings = geometry::openings(mesh.vertices, halves);
    if (!geometry::is_nearly_closed(mesh.vertices, mesh.triangles, openings)) return {scene::MassKind::area};
    const Matrix4 moments = geometry::capped_solid_moments(mesh.vertices, mesh.triangles, openings);
    if (!scene::centre_of_mass(moments)) return {scene::MassKind::area};
    return {scene::MassKind::volume, !(moments(3, 3) > 0), !solids::is_closed(halves)};
}

/// A solid that is inside out is turned: which side is out is not what its file meant to say. @return whether it is
bool decide_mass(const files::JsonNode& node, const MeshMass& mass, const geometry::Mesh& mesh, scene::Body& body) {
    body.mass_kind = mass.kind;
    body.mass_kind_given = false;
    if (body.type != scene::BodyType::dynamic_body || mesh.triangles.empty()) return false;
    if (mass.kind == scene::MassKind::area) node.warn("the mesh is open: it is a shell, and its density is per square metre");
    if (mass.has_gaps && !mass.inside_out) node.warn("the mesh has gaps: it is a solid with these capped");
    if (mass.inside_out) node.warn("the mesh is inside out: its triangles are turned");
    return mass.inside_out;
}

geometry::Mesh made(const MeshSource& source) {
    geometry::Mesh mesh = *source.mesh;
    geometry::scale_mesh(mesh, source.factors);
    if (source.turned) geometry::turn_triangles(mesh);
    return mesh;
}

void read_kinematic(const files::JsonNode& node, const std::array<bool, 6>& fixed, double timestep, scene::Body& body) {
    const double stop = node["kinematic_max_time"].unless_null().number().value_or(-1);
    for (int dof = 0; dof < 6; ++dof) {
        scene::MotionCurve curve;
        curve.rate = dof < 3 ? body.linear_velocity[dof] : body.angular_velocity[dof - 3];
        if (fixed[dof]) curve.rate = 0;
        if (stop >= 0) curve.stop_time = stop;
        body.prescribed[dof] = curve;
    }
    const auto fixed_rotations = static_cast<int>(std::count(fixed.begin() + 3, fixed.end(), true));
    const std::optional<double> stop_time = stop >= 0 ? std::optional<double>(stop) : std::nullopt;
    body.script = read_kinematic_poses(node["kinematic_poses"].unless_null(), body, fixed_rotations, timestep, stop_time);
}

void read_motion(const files::JsonNode& node, const std::array<bool, 6>& fixed, double timestep, scene::Body& body) {
    body.linear_velocity = fixture_vector(node["linear_velocity"].unless_null()).value_or(Vector3::Zero());
    body.angular_velocity = scene::radians(1) * fixture_vector(node["angular_velocity"].unless_null()).value_or(Vector3::Zero());
    body.force = fixture_vector(node["force"].unless_null()).value_or(Vector3::Zero());
    body.torque = fixture_vector(node["torque"].unless_null()).value_or(Vector3::Zero());
    if (body.type == scene::BodyType::kinematic_body) read_kinematic(node, fixed, timestep, body);
    if (body.type != scene::BodyType::dynamic_body) {
        body.linear_velocity = body.angular_velocity = body.force = body.torque = Vector3::Zero();
    }
    if (body.type == scene::BodyType::static_body) body.prescribed.fill(scene::MotionCurve{});
    for (int dof = 0; dof < 6 && body.type == scene::BodyType::dynamic_body; ++dof) {
        if (fixed[dof]) body.prescribed[dof] = scene::MotionCurve{};
    }
}

}  // namespace

std::optional<Vector3> fixture_vector(const files::JsonNode& node) {
    const auto found = node.numbers();
    if (!found) return std::nullopt;
    if (found->size() < 3) {
        node.fail(found->size() == 2 ? ErrorCode::unsupported : ErrorCode::wrong_type,
                  found->size() == 2 ? no_2d : "a list of three numbers is expected, found " + node.shown());
        return std::nullopt;
    }
    return Vector3((*found)[0], (*found)[1], (*found)[2]);
}

FixtureBodies::MeshFile FixtureBodies::read_mesh_file(const std::string& name, const std::string& where) const {
    MeshFile out;
    out.where = where;
    const auto file = mesh_files::find_mesh_file(name, document_.path(), options_.mesh_dirs, where);
    if (!file) {
        out.errors = {file.errors().front()};
        out.errors.front().where.clear();
        return out;
    }
    mesh_files::MeshReadOptions options;
    options.unit = 1;
    options.weld = true;
    options.should_stop = options_.should_stop;
    auto found = mesh_files::read_mesh(*file, options);
    if (!found) {
        out.errors = found.errors();
        return out;
    }
    solids::MeshRequirements requirements;
    requirements.closed = false;
    for (const auto& fault : solids::validate_mesh(*found, requirements, 1)) out.warnings.push_back(fault.where + ": " + fault.message);
    out.mesh = *std::move(found);
    return out;
}

void FixtureBodies::read_mesh_files(const std::vector<files::JsonNode>& nodes) {
    std::vector<std::pair<const std::string*, MeshFile*>> wanted;
    std::vector<std::string> places;
    for (const files::JsonNode& node : nodes) {
        if (!node.is_object()) continue;
        const files::JsonNode file = node["mesh"], enabled = node["enabled"];
        const bool used = !enabled.is_bool() || enabled.boolean().value();
        if (!used || !file.is_string()) continue;
        const auto [entry, fresh] = files_.try_emplace(file.string().value());
        if (!fresh) continue;
        wanted.emplace_back(&entry->first, &entry->second);
        places.push_back(file.where());
    }
    base::parallel_for(count_of(wanted), 1, [&](int i) { *wanted[i].second = read_mesh_file(*wanted[i].first, places[i]); });
}

const geometry::Mesh* FixtureBodies::mesh_file(const files::JsonNode& node, const std::string& name) const {
    const MeshFile& file = files_.at(name);
    for (const auto& error : file.errors) node.fail(error.code, (error.where.empty() ? "" : error.where + ": ") + error.message);
    if (!file.errors.empty()) return nullptr;
    if (!file.warnings.empty() && file.where == node.where())
        for (const std::string& warning : file.warnings) node.warn(warning);
    return &file.mesh;
}

std::shared_ptr<const geometry::Mesh> FixtureBodies::inline_mesh(const files::JsonNode& node) const {
    geometry::Mesh mesh;
    mesh.name = "inline mesh";
    const files::JsonNode vertices = node["vertices"].unless_null();
    const auto rows = vertices.elements();
    if (rows.empty()) {
        node.fail(ErrorCode::missing_key, "a body needs a `mesh` or `vertices`");
        return nullptr;
    }
    mesh.vertices.resize(3, rows.size());
    bool good = true;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto vertex = fixture_vector(rows[i]);
        good = good && vertex.has_value();
        mesh.vertices.col(i) = vertex.value_or(Vector3::Zero());
    }
    const std::size_t faults = node.error_count();
    const int count = count_of(rows);
    mesh.triangles = files::index_rows<3>(node["faces"].unless_null(), count);
    const auto edges = files::index_rows<2>(node["edges"].unless_null(), count);
    if (!good || node.error_count() > faults) return nullptr;
    build_connectivity(mesh, edges);
    return std::make_shared<const geometry::Mesh>(weld_exactly(mesh));
}

/// Everything but mass and motion, which a component of a split body has for itself.
FixtureBodies::Placed FixtureBodies::placed(const files::JsonNode& node) const {
    Placed out;
    scene::Body& body = out.body;
    body.where = node.where();
    body.mesh_policy = scene::MeshPolicy::lenient;
    const files::JsonNode file = node["mesh"].unless_null();
    const auto name = file.string();
    if (file.exists() && !name) return {};
    if (name && !name->empty()) {
        out.file = *name;
        out.mesh = mesh_file(file, *name);
    } else {
        out.own = inline_mesh(node);
        out.mesh = out.own.get();
    }
    if (out.mesh == nullptr || out.mesh->vertices.cols() == 0) return {};
    out.factors = scale_factors(node, *out.mesh);
    body.name = std::filesystem::path(out.file).stem().string();
    if (body.name.empty()) body.name = "body";
    std::replace_if(
        body.name.begin(), body.name.end(), [](char c) { return c == ':' || c == ','; }, '_');
    const files::JsonNode rotation = node["rotation"].unless_null();
    if (rotation.is_number()) rotation.fail(ErrorCode::unsupported, no_2d);
    if (rotation.exists() && !rotation.is_number()) {
        body.pose.rotation = scene::rotation_from_degrees(fixture_vector(rotation).value_or(Vector3::Zero()));
    }
    body.pose.position = fixture_vector(node["position"].unless_null()).value_or(Vector3::Zero());
    body.group = std::max(-1, node["group_id"].unless_null().integer(std::numeric_limits<int>::min() + 1).value_or(-1));
    return out;
}

std::vector<std::vector<FixtureBody>> FixtureBodies::read(const files::JsonNode& list, double timestep) {
    const std::vector<files::JsonNode> nodes = list.elements();
    read_mesh_files(nodes);
    std::vector<std::vector<FixtureBody>> read(nodes.size());
    files::JsonNode::read_each(nodes, [&](std::size_t i, const files::JsonNode& node) { read[i] = read_body(node, timestep); });
    return read;
}

std::vector<FixtureBody> FixtureBodies::read_body(const files::JsonNode& node, double timestep) {
    node.warn_of_other_keys(fixture_body_keys);
    if (!node["enabled"].unless_null().boolean().value_or(true)) return {};
    Placed found = placed(node);
    if (found.mesh == nullptr) return {};
    scene::Body& body = found.body;
    const auto fixed = fixed_dofs(node["is_dof_fixed"].unless_null());
    body.type = body_type(node["type"].unless_null(), fixed);
    const files::JsonNode density = node["density"].unless_null();
    body.density = (body.type == scene::BodyType::dynamic_body ? density.number(files::positive) : density.number()).value_or(1000);
    body.density_given =
        density.exists() || body.type == scene::BodyType::dynamic_body;  // for a dynamic body 1000 is the format's own default
    MeshSource source{found.mesh, found.factors};
    const bool split = node["split_components"].unless_null().boolean().value_or(false);
    std::vector<FixtureBody> bodies;
    if (!split && !found.file.empty() && body.type != scene::BodyType::kinematic_body) {  // whose script is about its mesh's centre
        const MeshMass mass = mass_of(found, 0, [&] { return made(source); });
        source.turned = decide_mass(node, mass, *found.mesh, body);
        read_motion(node, fixed, timestep, body);
        bodies.push_back({std::move(body), source});
        return bodies;
    }
    std::size_t part = 0;
    for (geometry::Mesh& mesh : split ? solids::split_solids(made(source)) : std::vector<geometry::Mesh>{made(source)}) {
        const MeshMass mass = mass_of(found, part++, [&] { return mesh; });
        bodies.push_back({body, {}});
        scene::Body& last = bodies.back().body;
        if (decide_mass(node, mass, mesh, last)) geometry::turn_triangles(mesh);
        last.mesh = std::move(mesh);
        read_motion(node, fixed, timestep, last);
    }
    return bodies;
}

void FixtureBodies::fill(std::vector<scene::Body>& bodies, const std::vector<MeshSource>& sources) {
    base::parallel_for(count_of(bodies), 1, [&](int i) {
        if (sources[i].mesh != nullptr) bodies[i].mesh = made(sources[i]);
    });
}

MeshMass FixtureBodies::mass_of(const Placed& from, std::size_t part, const std::function<geometry::Mesh()>& mesh) {
    if (from.file.empty()) return look_at_mass(mesh());
    const std::lock_guard lock(masses_mutex_);
    const auto [entry, fresh] = masses_.try_emplace({from.file, {from.factors[0], from.factors[1], from.factors[2]}, part});
    if (fresh) entry->second = look_at_mass(mesh());
    return entry->second;
}

}  // namespace fettle::core::paper_scenes
