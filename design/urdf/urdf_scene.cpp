// SPDX-License-Identifier: MIT
#include "design/urdf/urdf_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <unordered_map>

#include "core/files/json_dump.hpp"
#include "core/files/unique_names.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/scene/inertial.hpp"
#include "design/urdf/joint_starts.hpp"
#include "design/urdf/robot_notes_json.hpp"

namespace fettle::design::urdf {

namespace {

using core::geometry::Mesh;
using core::kinematics::Pose;
using core::scene::Inertial;
using Json = nlohmann::ordered_json;

constexpr double default_density = 1000;

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
        out_.warnings = robot_.warnings;
        scene_ = {{"fettle_scene", 1},       {"description", "The robot \"" + robot_.name + "\", from its URDF file."},
                  {"units", "mm"},           {"gravity", {0, 0, -9.81}},
                  {"timestep", 0.005},       {"end_time", 1},
                  {"bodies", Json::array()}, {"joints", Json::array()}};
        find_tree();
        find_starts();
        if (errors_.empty()) walk_tree();
        if (errors_.empty()) couple();
        if (errors_.empty() && visited_ < robot_.links.size())
            errors_.push_back({ErrorCode::inconsistent, robot_.name, "its links form no tree: some are children of one another"});
        if (!errors_.empty()) return errors_;
        if (scene_["bodies"].empty()) return Error{ErrorCode::mesh_invalid, robot_.name, "no link has any geometry"};
        if (scene_["joints"].empty()) scene_.erase("joints");
        for (Json& body : scene_["bodies"]) write_rest(body);
        tell_what_is_left_out();
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
            if (!robot_.links[i].geometry().empty()) mark_way_to_root(robot_.links[i].name);
            if (parent_joint_.count(robot_.links[i].name) != 0) continue;
            if (root_ >= 0)
                errors_.push_back({ErrorCode::inconsistent, robot_.name,
                                   "two links have no parent: \"" + robot_.links[root_].name + "\" and \"" + robot_.links[i].name + "\""});
            root_ = static_cast<int>(i);
        }
        if (root_ < 0) errors_.push_back({ErrorCode::inconsistent, robot_.name, "every link has a parent, so that there is no root"});
    }

    /// Something with geometry hangs from all of these.
    void mark_way_to_root(std::string link) {
        while (carrying_.insert(link).second) {
            const auto joint = parent_joint_.find(link);
            if (joint == parent_joint_.end()) return;
            link = joint->second->parent;
        }
    }

    void find_starts() {
        Result<JointStarts> starts = joint_starts(robot_);
        errors_.insert(errors_.end(), starts.errors().begin(), starts.errors().end());
        if (!starts) return;
        starts_ = std::move(starts->of);
        out_.warnings.insert(out_.warnings.end(), starts->warnings.begin(), starts->warnings.end());
    }

    /// A link to be visited.
    struct Visit {
        const Joint* joint = nullptr;  // that it hangs from; null: the root
        std::size_t link = 0;
        Pose pose;              // of the link's frame in the world
        std::string body;       // that it hangs from; empty: the world
        bool still = false;     // does the link not move?
        bool left_out = false;  // it moves, and nothing with geometry hangs from it
    };

    /// A link before its children, and those in the order of the joints. By a list of what is to come: a chain may have any length.
    void walk_tree() {
        std::vector<Visit> ahead{{nullptr, static_cast<std::size_t>(root_), Pose{}, "", !options_.floating, false}};
        while (!ahead.empty()) {
            Visit visit = std::move(ahead.back());
            ahead.pop_back();
            const Link& link = robot_.links[visit.link];
            ++visited_;
            if (visit.left_out) {
                told_["left out, for they move and have no geometry, nor has what hangs from them: the links"].push_back(link.name);
            } else {
                if (visit.joint && !link.geometry().empty()) {
                    if (visit.still)
                        told_["not in the scene, for what they join does not move: the joints"].push_back(visit.joint->name);
                    else
                        add_joint(*visit.joint, visit.pose, visit.body);
                }
                take_link(visit);
            }
            const std::vector<const Joint*>& joints = children_[link.name];
            for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) ahead.push_back(below(visit, **joint));
        }
    }

    /// @param visit  its body becomes the link's own, if it has one: what its children hang from.
    void take_link(Visit& visit) {
        const Link& link = robot_.links[visit.link];
        if (!link.geometry().empty()) {
            visit.body = bodies_[visit.link];
            add_body(link, visit.body, visit.pose, visit.still);
        } else if (visit.joint && !is_fixed(*visit.joint)) {
            errors_.push_back(
                {ErrorCode::unsupported, robot_.name, "the link \"" + link.name + "\" moves and has no geometry; give it a small one"});
        } else {
            add_frame(visit, link);
            if (link.has_mass()) add_to(visit.body, link, visit.pose);
        }
    }

    /// Does the link stay where the joint's other one has it?
    bool is_fixed(const Joint& joint) const {
        const auto start = starts_.find(joint.name);
        return joint.type == "fixed" || (start != starts_.end() && start->second.is_held);
    }

    double start_of(const Joint& joint) const {
        const auto start = starts_.find(joint.name);
        return start == starts_.end() ? 0 : start->second.coordinate;
    }

    Visit below(const Visit& parent, const Joint& joint) const {
        Visit child{&joint, index_of_.at(joint.child), composed(parent.pose, joint.origin), parent.body, false, parent.left_out};
        child.still = parent.body.empty() && is_fixed(joint);
        if (joint.has_coordinate()) child.pose = composed(child.pose, motion_of(joint.slides(), joint.axis, start_of(joint)));
        if (!is_fixed(joint) && carrying_.count(joint.child) == 0) child.left_out = true;
        return child;
    }

    void add_frame(const Visit& visit, const Link& link) {
        const auto carrier = bodies_made_.find(visit.body);
        if (!visit.joint || carrier == bodies_made_.end()) {
            told_["frames of the world, which are left out: the links"].push_back(link.name);
            return;
        }
        carrier->second.notes.frames.push_back({link.name, visit.joint->name, composed(inverse(carrier->second.pose), visit.pose)});
    }

    void add_body(const Link& link, const std::string& name, const Pose& pose, bool still) {
        const Result<Mesh> mesh = link_mesh(link, options_.meshes);
        errors_.insert(errors_.end(), mesh.errors().begin(), mesh.errors().end());
        if (!mesh) return;
        if (name != link.name) out_.warnings.push_back("link \"" + link.name + "\": its body is called \"" + name + "\"");
        tell_of_geometry(link);
        const std::string file = options_.stem + ".meshes/" + files_.unique(core::files::file_stem(name)) + ".obj";
        out_.files.emplace_back(file, core::mesh_files::obj_text({{name, &*mesh}}));
        Json body{{"name", name}};
        if (still) {
            body["type"] = "static";
        } else {
            const double volume = core::geometry::solid_moments(mesh->vertices, mesh->triangles)(3, 3);
            const bool known = link.has_mass() && volume > 0;
            body["density"] = known ? *link.mass / volume : default_density;
            if (!known && !inertial_of_link(link))
                out_.warnings.push_back("link \"" + link.name + "\": no mass, or no volume for it; its density is taken as 1000 kg/m^3");
        }
        bodies_made_[name] = {pose, inertial_of_link(link), {link.colour, {}}};
        body["mesh"] = file;
        body["position"] = numbers(1e3 * pose.position);
        const Vector3 rpy = rpy_of_rotation(pose.rotation);
        const Eigen::AngleAxisd turn(pose.rotation);
        if (rpy.norm() > 0) body["rotation_vector"] = numbers(180 / M_PI * turn.angle() * turn.axis());
        scene_["bodies"].push_back(std::move(body));
    }

    void tell_of_geometry(const Link& link) {
        if (!link.collision.empty() && !link.visual.empty())
            told_["what is seen is what touches, and visual geometry is left out, of the links"].push_back(link.name);
        const auto is_round = [](const Geometry& each) { return each.kind == GeometryKind::cylinder || each.kind == GeometryKind::sphere; };
        if (std::any_of(link.geometry().begin(), link.geometry().end(), is_round))
            told_["cylinders and spheres are polyhedra inside them, of the links"].push_back(link.name);
    }

    /// Along the link's axes; nothing where the file has none, or one that no body has.
    std::optional<Inertial> inertial_of_link(const Link& link) {
        if (!link.has_mass() || !link.inertia) return std::nullopt;
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
        const auto parent = bodies_made_.find(body);
        const std::optional<Inertial> own = inertial_of_link(link);
        if (parent == bodies_made_.end() || !parent->second.inertial || !own) {
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

    /// What is known of a body at the end: all that its frames weigh, and where they are.
    void write_rest(Json& body) const {
        const auto found = bodies_made_.find(body["name"].get<std::string>());
        if (found == bodies_made_.end()) return;
        if (found->second.inertial) {
            const Inertial& own = *found->second.inertial;
            Json rows = Json::array();
            for (int k = 0; k < 3; ++k) rows.push_back(numbers(own.inertia.row(k).transpose()));
            body.erase("density");
            body["inertial"] = {{"mass", own.mass}, {"centre", numbers(1e3 * own.centre)}, {"inertia", rows}};
        }
        if (!found->second.notes.empty()) body["urdf"] = notes_json(found->second.notes);
    }

    /// @param child  the frame of the child's link. @param parent  a body, or empty for the world.
    void add_joint(const Joint& joint, const Pose& child, const std::string& parent) {
        if (joint.type == "floating") return;
        const std::string type = is_fixed(joint) ? "fixed" : joint.turns() ? "revolute" : joint.type;
        Json out{{"name", joint.name}, {"type", type}};
        if (!parent.empty()) out["a"] = parent;
        out["b"] = bodies_[index_of_.at(joint.child)];
        out["point"] = numbers(1e3 * child.position);
        if (type != "fixed") out["axis"] = numbers(child.rotation * joint.axis);
        if (type == "revolute" || type == "prismatic") {
            const double unit = joint.turns() ? 180 / M_PI : 1e3, start = start_of(joint);
            if (joint.is_limited()) out["limits"] = {(*joint.lower - start) * unit, (*joint.upper - start) * unit};
            if (joint.damping > 0) out["damping"] = joint.damping;
            if (joint.friction > 0) out["friction"] = joint.friction;
            const JointNotes notes{start, joint.effort, joint.velocity};
            if (!notes.empty()) out["urdf"] = notes_json(notes, joint.turns());
        } else if (joint.effort || joint.velocity) {
            told_["effort and velocity mean nothing there and are left out, of the joints"].push_back(joint.name);
        }
        if (joint.damping < 0 || joint.friction < 0)
            told_["damping and friction below 0 are left out, of the joints"].push_back(joint.name);
        in_scene_.insert(joint.name);
        scene_["joints"].push_back(std::move(out));
    }

    /// A joint that mimics another: a gear between two that turn or two that slide, a rack between one that turns and one that slides.
    void couple() {
        for (const Joint& joint : robot_.joints) {
            if (joint.mimics.empty() || in_scene_.count(joint.name) == 0) continue;
            if (is_fixed(joint)) {
                told_["fixed, for they mimic with a multiplier of 0: the joints"].push_back(joint.name);
                continue;
            }
            const Joint& other = *joint_of_.at(joint.mimics);
            if (in_scene_.count(other.name) == 0) {
                told_["free, for what they mimic is left out: the joints"].push_back(joint.name);
                continue;
            }
            Json out{{"name", joint.name + " mimics " + joint.mimics}};
            if (joint.turns() == other.turns()) {
                out.update({{"type", "gear"}, {"of", {other.name, joint.name}}, {"ratio", joint.multiplier}});
            } else if (other.turns()) {
                out.update({{"type", "rack"}, {"of", {other.name, joint.name}}, {"radius", 1e3 * joint.multiplier}});
            } else {
                out.update({{"type", "rack"}, {"of", {joint.name, other.name}}, {"radius", 1e3 / joint.multiplier}});
            }
            scene_["joints"].push_back(std::move(out));
        }
    }

    void tell_what_is_left_out() {
        for (const auto& [what, names] : told_) out_.warnings.push_back(what + " " + some_of(names));
    }

    const Robot& robot_;
    const ImportOptions& options_;
    Json scene_;
    ImportedScene out_;
    Errors errors_;
    std::unordered_map<std::string, const Joint*> parent_joint_, joint_of_;
    std::unordered_map<std::string, std::vector<const Joint*>> children_;  // by the parent's name
    std::unordered_map<std::string, std::size_t> index_of_;                // of links
    std::unordered_map<std::string, JointStart> starts_;                   // by joint
    std::vector<std::string> bodies_;                                      // per link, the name of what becomes of it
    std::set<std::string> carrying_;                                       // links that have geometry, or something below them
    std::set<std::string> in_scene_;                                       // joints
    std::map<std::string, std::vector<std::string>> told_;                 // what is left out or changed, and where
    core::files::UniqueNames files_{"_", true};
    struct BodyMade {
        Pose pose;                         // of the body's frame in the world
        std::optional<Inertial> inertial;  // along its axes
        BodyNotes notes;
    };
    std::map<std::string, BodyMade> bodies_made_;  // by name
    std::set<std::string> doubted_;                // links whose inertia no body has
    int root_ = -1;
    std::size_t visited_ = 0;
};

}  // namespace

Result<ImportedScene> scene_of_robot(const Robot& robot, const ImportOptions& options) { return SceneMaker(robot, options).make(); }

}  // namespace fettle::design::urdf
