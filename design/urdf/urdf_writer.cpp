// SPDX-License-Identifier: MIT
#include "fettle/design/urdf/urdf_writer.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "fettle/core/base/text.hpp"
#include "fettle/core/files/unique_names.hpp"
#include "fettle/core/mesh_files/mesh_writer.hpp"
#include "fettle/core/mesh_files/millimetres.hpp"

namespace fettle::design::urdf {

namespace {

using core::kinematics::Pose;
using core::mesh_files::decimal;
using core::scene::JointKind;

std::string text_of(const Vector3& x) { return decimal(x[0]) + " " + decimal(x[1]) + " " + decimal(x[2]); }

std::string in_quotes(const std::string& text) { return "\"" + core::base::xml_text(text) + "\""; }

std::string origin_text(const Pose& pose) {
    return "<origin xyz=\"" + text_of(pose.position) + "\" rpy=\"" + text_of(rpy_of_rotation(pose.rotation)) + "\"/>";
}

Pose inverse(const Pose& pose) { return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.position)}; }

constexpr int world = -1;

/// How a body hangs.
struct Hanging {
    int parent = world;
    const core::scene::Joint* joint = nullptr;  ///< null: fixed to the world, or floating
    bool turned = false;                        ///< the body is the joint's `a`: its coordinate counts backwards
    Pose frame;                                 ///< of the link in the world at the start
};

class RobotWriter {
public:
    RobotWriter(const core::scene::Scene& scene, const core::model::Model& model, std::string stem)
        : scene_(scene), model_(model), stem_(std::move(stem)), hanging_(scene.bodies.size()) {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) index_of_.try_emplace(scene.bodies[i].name, static_cast<int>(i));
    }

    Result<ExportedRobot> write() {
        check_kinds();
        if (errors_.empty()) find_tree();
        if (!errors_.empty()) return errors_;
        tell_what_is_left_out();
        name_links();
        std::string text = "<?xml version=\"1.0\"?>\n<robot name=" + in_quotes(stem_) + ">\n<link name=\"world\"/>\n";
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) text += link_text(i);
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) text += joint_text(i);
        out_.files.insert(out_.files.begin(), {stem_ + ".urdf", text + "</robot>\n"});
        return std::move(out_);
    }

private:
    /// "world" is the root; what carries a body into it is named here, beside the scene's own joints.
    void name_links() {
        core::files::UniqueNames links, joints;
        links.unique("world");
        for (const core::scene::Joint& joint : scene_.mechanism.joints) joints.unique(joint.name);
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const std::string& name = scene_.bodies[i].name;
            links_.push_back(links.unique(name));
            if (links_.back() != name)
                out_.warnings.push_back("body \"" + name + "\": its link is called \"" + links_.back() + "\", as the other name is taken");
            carriers_.push_back(hanging_[i].joint ? hanging_[i].joint->name : joints.unique("world to " + links_.back()));
        }
    }

    static bool is_coupling(const core::scene::Joint& joint) { return joint.kind == JointKind::gear || joint.kind == JointKind::rack; }

    void check_kinds() {
        for (const core::scene::Joint& joint : scene_.mechanism.joints) {
            if (joint.kind == JointKind::ball || joint.kind == JointKind::cylindrical || joint.kind == JointKind::screw)
                errors_.push_back(
                    {ErrorCode::unsupported, joint.where, "the joint \"" + joint.name + "\" is of a kind that URDF does not have"});
        }
    }

    int body_index(const std::string& name) const {
        const auto found = index_of_.find(name);
        return found == index_of_.end() ? world : found->second;
    }

    static bool stays(const core::scene::Body& body) { return body.type == core::scene::BodyType::static_body; }

    /// From the world and what stays in it, joint by joint in their order; what no joint reaches is a root of its own.
    void find_tree() {
        std::vector<bool> placed(scene_.bodies.size());
        std::vector<bool> used(scene_.mechanism.joints.size());
        const auto is_placed = [&](int body) { return body == world || placed[body]; };
        const auto hang = [&](int body, Hanging from) {
            hanging_[body] = from;
            placed[body] = true;
        };
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
            if (stays(scene_.bodies[i])) hang(static_cast<int>(i), {world, nullptr, false, scene_.bodies[i].pose});
        for (bool again = true; again;) {
            again = false;
            for (std::size_t j = 0; j < used.size(); ++j) {
                const core::scene::Joint& joint = scene_.mechanism.joints[j];
                const int a = body_index(joint.a.body), b = body_index(joint.b.body);
                if (used[j] || is_coupling(joint) || is_placed(a) == is_placed(b)) continue;
                const bool turned = is_placed(b);
                const core::scene::Attachment& end = turned ? joint.a : joint.b;
                const Pose& pose = scene_.bodies[turned ? a : b].pose;
                hang(turned ? a : b, {turned ? b : a, &joint, turned, {pose.rotation, core::kinematics::world_position(pose, end.point)}});
                used[j] = again = true;
            }
            const auto left = std::find(placed.begin(), placed.end(), false);
            if (again || left == placed.end()) continue;
            const int root = static_cast<int>(left - placed.begin());
            hang(root, {world, nullptr, false, scene_.bodies[root].pose});
            again = true;
        }
        for (std::size_t j = 0; j < used.size(); ++j) {
            const core::scene::Joint& joint = scene_.mechanism.joints[j];
            if (used[j] || is_coupling(joint)) continue;
            errors_.push_back(
                {ErrorCode::unsupported, joint.where, "the joint \"" + joint.name + "\" closes a loop, which URDF cannot say"});
        }
    }

    void tell_what_is_left_out() {
        const auto& mechanism = scene_.mechanism;
        const std::size_t count = mechanism.springs.size() + mechanism.motors.size() + mechanism.loads.size();
        if (count > 0)
            out_.warnings.push_back("springs, dampers between points, motors and loads are not in a URDF file: " + std::to_string(count) +
                                    " left out");
        for (const core::scene::Joint& joint : mechanism.joints)
            if (joint.forces.stiffness > 0) out_.warnings.push_back("joint \"" + joint.name + "\": its stiffness is left out");
    }

    std::string link_text(std::size_t i) {
        const core::scene::Body& body = scene_.bodies[i];
        const Pose file = composed(inverse(hanging_[i].frame), body.pose);
        const std::string path = stem_ + ".meshes/" + files_.unique(core::files::file_stem(body.name)) + ".stl";
        std::string text = "<link name=" + in_quotes(links_[i]) + ">\n" + inertial_text(i, file);
        if (!body.mesh.triangles.empty()) {
            out_.files.emplace_back(path, core::mesh_files::stl_bytes({{body.name, &body.mesh}}));
            for (const char* section : {"visual", "collision"})
                text += "<" + std::string(section) + ">" + origin_text(file) + "<geometry><mesh filename=" + in_quotes(path) +
                        " scale=\"0.001 0.001 0.001\"/></geometry></" + section + ">\n";
        }
        return text + "</link>\n";
    }

    /// As the scene gives it, else of the model's second moments; axes of the file.
    std::string inertial_text(std::size_t i, const Pose& file) const {
        const core::model::Body& body = model_.bodies[i];
        const std::optional<core::scene::Inertial>& given = scene_.bodies[i].inertial;  // of what does not move, too
        if (!given && !(body.moments(3, 3) > 0)) return "";
        core::scene::Inertial own = given ? *given : core::scene::inertial_of(body.moments);
        if (!given) own.centre += body.reference_point;
        const Matrix3& inertia = own.inertia;
        const auto entry = [&](const char* name, int r, int c) { return std::string(" ") + name + "=\"" + decimal(inertia(r, c)) + "\""; };
        const Pose at{file.rotation, core::kinematics::world_position(file, own.centre)};
        return "<inertial>" + origin_text(at) + "<mass value=\"" + decimal(own.mass) + "\"/><inertia" + entry("ixx", 0, 0) +
               entry("ixy", 0, 1) + entry("ixz", 0, 2) + entry("iyy", 1, 1) + entry("iyz", 1, 2) + entry("izz", 2, 2) + "/></inertial>\n";
    }

    static const char* type_of(const core::scene::Joint& joint) {
        switch (joint.kind) {
            case JointKind::revolute:
                return joint.forces.limits ? "revolute" : "continuous";
            case JointKind::prismatic:
                return "prismatic";
            case JointKind::planar:
                return "planar";
            default:
                return "fixed";
        }
    }

    std::string joint_text(std::size_t i) const {
        const Hanging& from = hanging_[i];
        const core::scene::Body& body = scene_.bodies[i];
        const std::string parent = from.parent == world ? "world" : links_[from.parent];
        const Pose above = from.parent == world ? Pose{} : hanging_[from.parent].frame;
        const std::string type = from.joint ? type_of(*from.joint) : stays(body) ? "fixed" : "floating";
        std::string text = "<joint name=" + in_quotes(carriers_[i]) + " type=\"" + type + "\"><parent link=" + in_quotes(parent) +
                           "/><child link=" + in_quotes(links_[i]) + "/>" + origin_text(composed(inverse(above), from.frame));
        if (from.joint && type != "fixed") text += motion_text(*from.joint, from);
        return text + "</joint>\n";
    }

    std::string motion_text(const core::scene::Joint& joint, const Hanging& from) const {
        // The coordinate goes from a to b; hung the other way round it is the same about the opposite axis.
        const Vector3 axis = from.turned ? Vector3(-joint.a.axis) : joint.b.axis;
        std::string text = "<axis xyz=\"" + text_of(axis.normalized()) + "\"/>";
        if (joint.forces.limits || joint.kind == JointKind::prismatic) {  // the format wants limits of what slides
            const auto limits = joint.forces.limits.value_or(std::array<double, 2>{-1e3, 1e3});
            text += "<limit lower=\"" + decimal(limits[0]) + "\" upper=\"" + decimal(limits[1]) + "\" effort=\"1e6\" velocity=\"1e6\"/>";
        }
        if (joint.forces.damping > 0 || joint.forces.friction > 0)
            text += "<dynamics damping=\"" + decimal(joint.forces.damping) + "\" friction=\"" + decimal(joint.forces.friction) + "\"/>";
        for (const core::scene::Joint& coupling : scene_.mechanism.joints) {
            if (!is_coupling(coupling) || coupling.of[1] != joint.name) continue;
            text += "<mimic joint=" + in_quotes(coupling.of[0]) + " multiplier=\"" + decimal(coupling.ratio) + "\"/>";
        }
        return text;
    }

    const core::scene::Scene& scene_;
    const core::model::Model& model_;
    std::string stem_;
    std::vector<Hanging> hanging_;
    std::vector<std::string> links_, carriers_;      // per body: its link, and the joint that it hangs from
    std::unordered_map<std::string, int> index_of_;  // bodies by name
    core::files::UniqueNames files_{"_", true};
    ExportedRobot out_;
    Errors errors_;
};

}  // namespace

Result<ExportedRobot> robot_of_scene(const core::scene::Scene& scene, const core::model::Model& model, const std::string& stem) {
    return RobotWriter(scene, model, stem).write();
}

}  // namespace fettle::design::urdf
