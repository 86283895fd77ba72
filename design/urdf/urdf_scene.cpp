// SPDX-License-Identifier: MIT
#include "fettle/design/urdf/urdf_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "fettle/core/files/json_dump.hpp"
#include "fettle/core/files/unique_names.hpp"
#include "fettle/core/geometry/mass_moments.hpp"
#include "fettle/core/geometry/mesh_transforms.hpp"
#include "fettle/core/mesh_files/mesh_reader.hpp"
#include "fettle/core/mesh_files/mesh_writer.hpp"
#include "fettle/core/scene/inertial.hpp"
#include "fettle/design/shapes/file_part.hpp"

namespace fettle::design::urdf {

namespace {

namespace fs = std::filesystem;
using core::geometry::Mesh;
using core::kinematics::Pose;
using core::scene::Inertial;
using Json = nlohmann::ordered_json;

constexpr double default_density = 1000;
constexpr int sphere_rounds = 3;  // of an octahedron cut in four: 512 triangles

/// Vertices on the sphere.
Mesh sphere_mesh(double radius) {
    std::vector<Vector3> vertices{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<core::geometry::Triangle> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int round = 0; round < sphere_rounds; ++round) {
        std::map<std::array<int, 2>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [found, added] = middles.insert({{std::min(a, b), std::max(a, b)}, count_of(vertices)});
            if (added) vertices.push_back((vertices[a] + vertices[b]).normalized());
            return found->second;
        };
        std::vector<core::geometry::Triangle> finer;
        for (const auto& t : triangles) {
            const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    Matrix3X x(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(i) = radius * vertices[i];
    return core::geometry::make_mesh("sphere", x, triangles);
}

Result<Mesh> part_mesh(const std::string& part, const std::map<std::string, double>& dimensions) {
    const auto shape = shapes::FilePart::create(part, dimensions);
    return shape ? description::drawn_mesh(**shape) : Result<Mesh>(shape.errors());
}

/// Where a mesh may be: as it is named, relative to the file; of package://NAME/x also NAME/x and x below each folder above it.
Result<std::string> find_mesh(std::string name, const ImportOptions& options) {
    bool package = false;
    for (const char* prefix : {"package://", "file://", "model://"}) {
        if (!name.starts_with(prefix)) continue;
        package = std::string_view(prefix) != "file://";
        name.erase(0, std::string_view(prefix).size());
        break;
    }
    std::vector<fs::path> folders{options.folder.empty() ? fs::path(".") : fs::path(options.folder)};
    folders.insert(folders.end(), options.mesh_dirs.begin(), options.mesh_dirs.end());
    if (package)
        for (fs::path up = fs::absolute(folders.front()); up.has_relative_path(); up = up.parent_path()) folders.push_back(up);
    std::vector<std::string> names{name};
    if (package && name.find('/') != std::string::npos) names.push_back(name.substr(name.find('/') + 1));
    std::error_code code;
    for (const fs::path& folder : folders)
        for (const std::string& each : names)
            if (fs::is_regular_file(folder / each, code)) return (folder / each).string();
    return Error{ErrorCode::file_not_found, name,
                 "the robot's mesh is not there; looked for it beside the file, in its packages' folders, and in --mesh-dir"};
}

Result<Mesh> mesh_of(const Geometry& geometry, const ImportOptions& options) {
    switch (geometry.kind) {
        case GeometryKind::box:
            return part_mesh("box", {{"size_x", geometry.size.x()}, {"size_y", geometry.size.y()}, {"size_z", geometry.size.z()}});
        case GeometryKind::cylinder:
            return part_mesh("cylinder", {{"radius", geometry.radius}, {"length", geometry.length}});
        case GeometryKind::sphere:
            return sphere_mesh(geometry.radius);
        case GeometryKind::mesh:
            break;
    }
    const Result<std::string> path = find_mesh(geometry.file, options);
    if (!path) return path.errors();
    Result<Mesh> mesh = core::mesh_files::read_mesh(*path);
    if (mesh) core::geometry::scale_mesh(*mesh, geometry.scale);
    return mesh;
}

/// All geometry of a link, in its frame.
Result<Mesh> link_mesh(const Link& link, const ImportOptions& options) {
    std::vector<Vector3> vertices;
    std::vector<core::geometry::Triangle> triangles;
    Errors errors;
    for (const Geometry& geometry : link.geometry()) {
        const Result<Mesh> mesh = mesh_of(geometry, options);
        errors.insert(errors.end(), mesh.errors().begin(), mesh.errors().end());
        if (!mesh) continue;
        const int first = count_of(vertices);
        for (const auto& x : mesh->vertices.colwise()) vertices.push_back(core::kinematics::world_position(geometry.origin, x));
        for (const auto& t : mesh->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    if (!errors.empty()) return errors;
    Matrix3X x(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) x.col(i) = vertices[i];
    return core::geometry::make_mesh(link.name, x, triangles);
}

/// Names that a scene's lists of pairs can be written with, and files.
std::string plain(std::string name) {
    for (char& c : name)
        if (c == ':' || c == ',' || c == '/' || c == '\\') c = '_';
    return name;
}

Json numbers(const Vector3& x) { return {x[0], x[1], x[2]}; }

class SceneMaker {
public:
    SceneMaker(const Robot& robot, const ImportOptions& options) : robot_(robot), options_(options) {}

    Result<ImportedScene> make() {
        scene_ = {{"fettle_scene", 1},       {"description", "The robot \"" + robot_.name + "\", from its URDF file."},
                  {"units", "mm"},           {"gravity", {0, 0, -9.81}},
                  {"timestep", 0.005},       {"end_time", 1},
                  {"bodies", Json::array()}, {"joints", Json::array()}};
        find_tree();
        if (errors_.empty()) walk_tree();
        if (errors_.empty()) couple();
        if (errors_.empty() && visited_ < robot_.links.size())
            errors_.push_back({ErrorCode::inconsistent, robot_.name, "its links form no tree: some are children of one another"});
        if (!errors_.empty()) return errors_;
        if (scene_["bodies"].empty()) return Error{ErrorCode::mesh_invalid, robot_.name, "no link has any geometry"};
        if (scene_["joints"].empty()) scene_.erase("joints");
        for (Json& body : scene_["bodies"]) write_inertial(body);
        out_.files.insert(out_.files.begin(), {options_.stem + ".scene.json", core::files::dumped(scene_, 2) + "\n"});
        return std::move(out_);
    }

private:
    void find_tree() {
        core::files::UniqueNames bodies;
        for (std::size_t i = 0; i < robot_.links.size(); ++i) {
            index_of_[robot_.links[i].name] = i;
            bodies_.push_back(bodies.unique(plain(robot_.links[i].name)));
        }
        for (const Joint& joint : robot_.joints) {
            joint_of_[joint.name] = &joint;
            children_[joint.parent].push_back(&joint);
            if (!parent_joint_.insert({joint.child, &joint}).second)
                errors_.push_back({ErrorCode::inconsistent, robot_.name, "the link \"" + joint.child + "\" is the child of two joints"});
        }
        for (std::size_t i = 0; i < robot_.links.size(); ++i) {
            if (parent_joint_.count(robot_.links[i].name) != 0) continue;
            if (root_ >= 0)
                errors_.push_back({ErrorCode::inconsistent, robot_.name,
                                   "two links have no parent: \"" + robot_.links[root_].name + "\" and \"" + robot_.links[i].name + "\""});
            root_ = static_cast<int>(i);
        }
        if (root_ < 0) errors_.push_back({ErrorCode::inconsistent, robot_.name, "every link has a parent, so that there is no root"});
    }

    /// A link to be visited.
    struct Visit {
        const Joint* joint = nullptr;  // that it hangs from; null: the root
        std::size_t link = 0;
        Pose pose;           // of the link's frame in the world
        std::string body;    // that it hangs from; empty: the world
        double start = 0;    // coordinate of the joint
        bool still = false;  // does the link not move?
    };

    /// A link before its children, and those in the order of the joints. By a list of what is to come: a chain may have any length.
    void walk_tree() {
        std::vector<Visit> ahead{{nullptr, static_cast<std::size_t>(root_), Pose{}, "", 0, !options_.floating}};
        while (!ahead.empty()) {
            Visit visit = std::move(ahead.back());
            ahead.pop_back();
            const Link& link = robot_.links[visit.link];
            const bool fixed_to_world = visit.joint && visit.still;
            if (visit.joint && !fixed_to_world && !link.geometry().empty()) add_joint(*visit.joint, visit.pose, visit.body, visit.start);
            take_link(visit);
            const std::vector<const Joint*>& joints = children_[link.name];
            for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) ahead.push_back(below(visit, **joint));
        }
    }

    /// @param visit  its body becomes the link's own, if it has one: what its children hang from.
    void take_link(Visit& visit) {
        const Link& link = robot_.links[visit.link];
        ++visited_;
        if (!link.geometry().empty()) {
            visit.body = bodies_[visit.link];
            add_body(link, visit.body, visit.pose, visit.still);
        } else if (visit.joint && visit.joint->type != "fixed") {
            errors_.push_back(
                {ErrorCode::unsupported, robot_.name, "the link \"" + link.name + "\" moves and has no geometry; give it a small one"});
        } else if (link.mass) {
            add_to(visit.body, link, visit.pose);
        }
    }

    Visit below(const Visit& parent, const Joint& joint) const {
        const Pose frame = composed(parent.pose, joint.origin);
        Visit child{&joint, index_of_.at(joint.child), frame, parent.body, start_of(joint), parent.body.empty() && joint.type == "fixed"};
        const Vector3 axis = joint.axis.normalized();
        if (joint.type == "prismatic") child.pose.position += child.start * (frame.rotation * axis);
        if (joint.type == "revolute") child.pose.rotation = frame.rotation * Eigen::AngleAxisd(child.start, axis).toRotationMatrix();
        return child;
    }

    static bool is_limited(const Joint& joint) {
        return joint.lower && joint.upper && *joint.lower < *joint.upper && (joint.type == "revolute" || joint.type == "prismatic");
    }
    static double start_of(const Joint& joint) { return is_limited(joint) ? std::clamp(0.0, *joint.lower, *joint.upper) : 0; }

    void add_body(const Link& link, const std::string& name, const Pose& pose, bool still) {
        const Result<Mesh> mesh = link_mesh(link, options_);
        errors_.insert(errors_.end(), mesh.errors().begin(), mesh.errors().end());
        if (!mesh) return;
        if (name != link.name) out_.warnings.push_back("link \"" + link.name + "\": its body is called \"" + name + "\"");
        const std::string file = options_.stem + ".meshes/" + files_.unique(core::files::file_stem(name)) + ".obj";
        out_.files.emplace_back(file, core::mesh_files::obj_text({{name, &*mesh}}));
        Json body{{"name", name}};
        if (still) {
            body["type"] = "static";
        } else {
            const double volume = core::geometry::solid_moments(mesh->vertices, mesh->triangles)(3, 3);
            const bool known = link.mass && volume > 0;
            body["density"] = known ? *link.mass / volume : default_density;
            if (!known && !inertial_of_link(link))
                out_.warnings.push_back("link \"" + link.name + "\": no mass, or no volume for it; its density is taken as 1000 kg/m^3");
        }
        masses_[name] = {pose, inertial_of_link(link)};
        body["mesh"] = file;
        body["position"] = numbers(1e3 * pose.position);
        const Vector3 rpy = rpy_of_rotation(pose.rotation);
        const Eigen::AngleAxisd turn(pose.rotation);
        if (rpy.norm() > 0) body["rotation_vector"] = numbers(180 / M_PI * turn.angle() * turn.axis());
        scene_["bodies"].push_back(std::move(body));
    }

    /// Along the link's axes; nothing where the file has none, or one that no body has.
    std::optional<Inertial> inertial_of_link(const Link& link) {
        if (!link.mass || !link.inertia) return std::nullopt;
        const Matrix3& turn = link.centre.rotation;
        const Inertial found{*link.mass, link.centre.position, turn * *link.inertia * turn.transpose()};
        const std::string fault = core::scene::fault_of(found);
        if (fault.empty()) return found;
        if (doubted_.insert(link.name).second)
            out_.warnings.push_back("link \"" + link.name + "\": its inertia is left out, that of a solid of its mass is taken: " + fault);
        return std::nullopt;
    }

    /// What a link without geometry weighs goes to the body that it is fixed to.
    void add_to(const std::string& body, const Link& link, const Pose& pose) {
        if (body.empty()) return;
        const auto parent = masses_.find(body);
        const std::optional<Inertial> own = inertial_of_link(link);
        if (parent == masses_.end() || !parent->second.inertial || !own) {
            out_.warnings.push_back("link \"" + link.name + "\": has no geometry, and its mass is left out: it and the link that it is " +
                                    "fixed to have no inertia each");
            return;
        }
        const Pose& to = parent->second.pose;
        Matrix4 shift = Matrix4::Identity();  // of the link's frame into that of the body
        shift.topLeftCorner<3, 3>() = to.rotation.transpose() * pose.rotation;
        shift.topRightCorner<3, 1>() = to.rotation.transpose() * (pose.position - to.position);
        const Matrix4 sum = core::scene::moments_about(*parent->second.inertial, Vector3::Zero()) +
                            shift * core::scene::moments_about(*own, Vector3::Zero()) * shift.transpose();
        parent->second.inertial = core::scene::inertial_of(sum);
    }

    void write_inertial(Json& body) const {
        const auto found = masses_.find(body["name"].get<std::string>());
        if (found == masses_.end() || !found->second.inertial) return;
        const Inertial& own = *found->second.inertial;
        Json rows = Json::array();
        for (int k = 0; k < 3; ++k) rows.push_back(numbers(own.inertia.row(k).transpose()));
        body.erase("density");
        body["inertial"] = {{"mass", own.mass}, {"centre", numbers(1e3 * own.centre)}, {"inertia", rows}};
    }

    /// @param child  the frame of the child's link. @param parent  a body, or empty for the world.
    void add_joint(const Joint& joint, const Pose& child, const std::string& parent, double start) {
        if (joint.type == "floating") return;
        const bool turns = joint.type == "revolute" || joint.type == "continuous";
        const std::string type = turns ? "revolute" : joint.type;
        Json out{{"name", joint.name}, {"type", type}};
        if (!parent.empty()) out["a"] = parent;
        out["b"] = bodies_[index_of_.at(joint.child)];
        out["point"] = numbers(1e3 * child.position);
        if (type != "fixed") out["axis"] = numbers(child.rotation * joint.axis);
        const double unit = turns ? 180 / M_PI : 1e3;
        if (is_limited(joint)) out["limits"] = {(*joint.lower - start) * unit, (*joint.upper - start) * unit};
        if (type == "revolute" || type == "prismatic") {
            if (joint.damping > 0) out["damping"] = joint.damping;
            if (joint.friction > 0) out["friction"] = joint.friction;
        }
        scene_["joints"].push_back(std::move(out));
    }

    /// A joint that mimics another: a gear between two that turn, a rack between one that turns and one that slides.
    void couple() {
        for (const Joint& joint : robot_.joints) {
            if (joint.mimics.empty()) continue;
            const auto other = joint_of_.find(joint.mimics);
            const auto turns = [](const Joint& j) { return j.type == "revolute" || j.type == "continuous"; };
            if (other == joint_of_.end() || !turns(*other->second) || !(turns(joint) || joint.type == "prismatic") ||
                joint.multiplier == 0) {
                errors_.push_back(
                    {ErrorCode::unsupported, robot_.name,
                     "the joint \"" + joint.name + "\" mimics \"" + joint.mimics + "\": only one that turns can be followed"});
                continue;
            }
            if (joint.offset != 0)
                out_.warnings.push_back("joint \"" + joint.name + "\" mimics with an offset: it starts at coordinate " +
                                        std::to_string(start_of(joint)) + ", and follows from there");
            Json out{{"name", joint.name + " mimics " + joint.mimics},
                     {"type", turns(joint) ? "gear" : "rack"},
                     {"of", {joint.mimics, joint.name}}};
            if (turns(joint)) {
                out["ratio"] = joint.multiplier;
            } else {
                out["radius"] = 1e3 * joint.multiplier;
            }
            scene_["joints"].push_back(std::move(out));
        }
    }

    const Robot& robot_;
    const ImportOptions& options_;
    Json scene_;
    ImportedScene out_;
    Errors errors_;
    std::map<std::string, const Joint*> parent_joint_, joint_of_;
    std::map<std::string, std::vector<const Joint*>> children_;  // by the parent's name
    std::map<std::string, std::size_t> index_of_;                // of links
    std::vector<std::string> bodies_;                            // per link, the name of what becomes of it
    core::files::UniqueNames files_{"_", true};
    struct BodyMass {
        Pose pose;                         // of the body's frame in the world
        std::optional<Inertial> inertial;  // along its axes
    };
    std::map<std::string, BodyMass> masses_;  // by body
    std::set<std::string> doubted_;           // links whose inertia no body has
    int root_ = -1;
    std::size_t visited_ = 0;
};

}  // namespace

Result<ImportedScene> scene_of_robot(const Robot& robot, const ImportOptions& options) { return SceneMaker(robot, options).make(); }

}  // namespace fettle::design::urdf
