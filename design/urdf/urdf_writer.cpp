// SPDX-License-Identifier: MIT
#include "design/urdf/urdf_writer.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/base/text.hpp"
#include "core/files/unique_names.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "core/mesh_files/millimetres.hpp"

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

constexpr int world = -1;

/// How a body hangs.
struct Hanging {
    int parent = world;
    const core::scene::Joint* joint = nullptr;  ///< null: fixed to the world, or floating
    bool turned = false;                        ///< the body is the joint's `a`: its coordinate counts backwards
    Pose frame;                                 ///< of the link in the world at the start

    /// In the link's frame. The coordinate goes from a to b; hung the other way round it is the same about the opposite axis.
    Vector3 axis() const { return turned ? Vector3(-joint->a.axis) : joint->b.axis; }
};

/// coordinate = multiplier * that of the other + offset, both as the file calls them.
struct Mimic {
    std::string joint;
    double multiplier = 1, offset = 0;
};

constexpr double unknown_effort = 1e6;  // the format wants one

class RobotWriter {
public:
    RobotWriter(const core::scene::Scene& scene, const core::model::Model& model, const RobotNotes& notes, std::string stem)
        : scene_(scene), model_(model), notes_(notes), stem_(std::move(stem)), hanging_(scene.bodies.size()) {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) index_of_.try_emplace(scene.bodies[i].name, static_cast<int>(i));
    }

    Result<ExportedRobot> write() {
        check_kinds();
        if (errors_.empty()) find_tree();
        if (errors_.empty()) find_mimics();
        if (!errors_.empty()) return errors_;
        name_links();
        std::string text = "<?xml version=\"1.0\"?>\n<robot name=" + in_quotes(stem_) + ">\n<link name=\"world\"/>\n";
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) text += link_text(i);
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) text += joint_text(i);
        out_.files.insert(out_.files.begin(), {stem_ + ".urdf", text + "</robot>\n"});
        tell_what_is_left_out();
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
        for (const core::scene::Body& body : scene_.bodies) {
            frames_.emplace_back();
            const auto noted = notes_.bodies.find(body.name);
            if (noted == notes_.bodies.end()) continue;
            for (FrameNote frame : noted->second.frames) {
                frame.name = links.unique(frame.name);
                frame.joint = joints.unique(frame.joint);
                frames_.back().push_back(std::move(frame));
            }
        }
    }

    static bool is_coupling(const core::scene::Joint& joint) { return core::scene::couples_joints(joint.kind); }

    JointNotes notes_of(const std::string& joint) const {
        const auto found = notes_.joints.find(joint);
        return found == notes_.joints.end() ? JointNotes{} : found->second;
    }

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

    /// Goes from the world and the bodies that stay in it, joint by joint in their order; what no joint reaches is a root of its own.
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

    /// A joint mimics one other at most: from the joints that nothing has follow another, coupling by coupling. Counted from the start,
    /// second = ratio * first; in the file's own words its coordinate is that and what it is called at the start.
    void find_mimics() {
        std::set<std::string> reached, following;
        std::vector<const core::scene::Joint*> left;
        for (const core::scene::Joint& joint : scene_.mechanism.joints) {
            if (is_coupling(joint)) left.push_back(&joint);
            if (is_coupling(joint)) following.insert(joint.of[1]);
        }
        while (!left.empty()) {
            auto next = std::find_if(left.begin(), left.end(), [&](const core::scene::Joint* each) {
                return reached.count(each->of[0]) + reached.count(each->of[1]) > 0;
            });
            if (next == left.end())
                next = std::find_if(left.begin(), left.end(), [&](const auto* each) { return following.count(each->of[0]) == 0; });
            if (next == left.end()) next = left.begin();
            const core::scene::Joint& coupling = **next;
            left.erase(next);
            const bool backwards = reached.count(coupling.of[1]) > 0;
            const std::string &drive = coupling.of[backwards ? 1 : 0], &follower = coupling.of[backwards ? 0 : 1];
            if (reached.count(follower) > 0) {
                errors_.push_back({ErrorCode::unsupported, coupling.where,
                                   "the joint \"" + coupling.name + "\" couples what others couple already, which URDF cannot say"});
                continue;
            }
            const double ratio = backwards ? 1 / coupling.ratio : coupling.ratio;
            mimics_[follower] = {drive, ratio, notes_of(follower).start - ratio * notes_of(drive).start};
            reached.insert({drive, follower});
        }
    }

    /// What a scene says and URDF cannot, by name.
    void tell_what_is_left_out() {
        const auto& mechanism = scene_.mechanism;
        std::map<std::string, std::vector<std::string>> told;
        for (const auto& spring : mechanism.springs) told["springs and dampers"].push_back(spring.name);
        for (const auto& motor : mechanism.motors) told["motors"].push_back(motor.name);
        for (const auto& load : mechanism.loads) told["loads"].push_back(load.name);
        if (!scene_.ignore.empty()) told["pairs of `ignore`"] = scene_.ignore;
        for (const core::scene::Joint& joint : mechanism.joints) {
            if (joint.forces.stiffness > 0) told["the stiffness of the joints"].push_back(joint.name);
            if (joint.assemble) told["`assemble` of the joints"].push_back(joint.name);
            if (joint.collide) told["`collide` of the joints"].push_back(joint.name);
        }
        for (const core::scene::Body& body : scene_.bodies) {
            const bool moves = !body.linear_velocity.isZero(0) || !body.angular_velocity.isZero(0);
            const bool is_driven = !body.script.empty() || (!stays(body) && std::any_of(body.prescribed.begin(), body.prescribed.end(),
                                                                                        [](const auto& each) { return each.has_value(); }));
            if (moves) told["velocities at the start of the bodies"].push_back(body.name);
            if (is_driven) told["`prescribed`, `fixed` and `script` of the bodies"].push_back(body.name);
            if (!body.force.isZero(0) || !body.torque.isZero(0)) told["`force` and `torque` of the bodies"].push_back(body.name);
            if (body.damping.linear > 0 || body.damping.angular > 0) told["`damping` of the bodies"].push_back(body.name);
            if (body.mu || !body.material.empty()) told["`mu` and `material` of the bodies"].push_back(body.name);
            if (body.group >= 0) told["`group` of the bodies"].push_back(body.name);
            if (!(model_.bodies[&body - scene_.bodies.data()].moments(3, 3) > 0) && !body.inertial && !stays(body))
                told["mass, for there is none, of the bodies"].push_back(body.name);
        }
        for (const auto& [what, names] : told) out_.warnings.push_back("not in a URDF file, and left out: " + what + " " + some_of(names));
        if (!unknown_efforts_.empty())
            out_.warnings.push_back(
                "`effort` and `velocity`, which the format wants, are not known and are written as 1e6, of the joints " +
                some_of(unknown_efforts_));
        if (!unlimited_slides_.empty())
            out_.warnings.push_back("limits, which the format wants of what slides, are written as -1000 and 1000 m, of the joints " +
                                    some_of(unlimited_slides_));
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
                        " scale=\"0.001 0.001 0.001\"/></geometry>" + (section[0] == 'v' ? material_text(i) : "") + "</" + section + ">\n";
        }
        text += "</link>\n";
        for (const FrameNote& frame : frames_[i])
            text += "<link name=" + in_quotes(frame.name) + "/>\n<joint name=" + in_quotes(frame.joint) +
                    " type=\"fixed\"><parent link=" + in_quotes(links_[i]) + "/><child link=" + in_quotes(frame.name) + "/>" +
                    origin_text(composed(file, frame.pose)) + "</joint>\n";
        return text;
    }

    std::string material_text(std::size_t i) const {
        const auto found = notes_.bodies.find(scene_.bodies[i].name);
        if (found == notes_.bodies.end() || !found->second.colour) return "";
        const Rgba& c = *found->second.colour;
        return "<material name=" + in_quotes(links_[i] + " colour") + "><color rgba=\"" + decimal(c[0]) + " " + decimal(c[1]) + " " +
               decimal(c[2]) + " " + decimal(c[3]) + "\"/></material>";
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

    std::string joint_text(std::size_t i) {
        const Hanging& from = hanging_[i];
        const core::scene::Body& body = scene_.bodies[i];
        const std::string parent = from.parent == world ? "world" : links_[from.parent];
        const Pose above = from.parent == world ? Pose{} : hanging_[from.parent].frame;
        const std::string type = from.joint ? type_of(*from.joint) : stays(body) ? "fixed" : "floating";
        Pose at_zero = from.frame;
        if (from.joint && has_coordinate(*from.joint))
            at_zero =
                composed(at_zero, motion_of(from.joint->kind == JointKind::prismatic, from.axis(), -notes_of(from.joint->name).start));
        std::string text = "<joint name=" + in_quotes(carriers_[i]) + " type=\"" + type + "\"><parent link=" + in_quotes(parent) +
                           "/><child link=" + in_quotes(links_[i]) + "/>" + origin_text(composed(inverse(above), at_zero));
        if (from.joint && type != "fixed") text += motion_text(*from.joint, from);
        return text + "</joint>\n";
    }

    static bool has_coordinate(const core::scene::Joint& joint) {
        return joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
    }

    std::string motion_text(const core::scene::Joint& joint, const Hanging& from) {
        std::string text = "<axis xyz=\"" + text_of(from.axis().normalized()) + "\"/>";
        if (has_coordinate(joint)) text += limit_text(joint);
        if (joint.forces.damping > 0 || joint.forces.friction > 0)
            text += "<dynamics damping=\"" + decimal(joint.forces.damping) + "\" friction=\"" + decimal(joint.forces.friction) + "\"/>";
        const auto mimic = mimics_.find(joint.name);
        if (mimic == mimics_.end()) return text;
        const auto& [other, multiplier, offset] = mimic->second;
        return text + "<mimic joint=" + in_quotes(other) + " multiplier=\"" + decimal(multiplier) + "\" offset=\"" + decimal(offset) +
               "\"/>";
    }

    /// The format wants limits of what slides, and effort and velocity of all that has limits.
    std::string limit_text(const core::scene::Joint& joint) {
        const JointNotes notes = notes_of(joint.name);
        const bool slides = joint.kind == JointKind::prismatic, has_limits = joint.forces.limits || slides;
        if (!has_limits && !notes.effort && !notes.velocity) return "";
        if (!notes.effort || !notes.velocity) unknown_efforts_.push_back(joint.name);
        if (slides && !joint.forces.limits) unlimited_slides_.push_back(joint.name);
        std::string text = "<limit";
        if (has_limits) {
            const auto limits = joint.forces.limits.value_or(std::array<double, 2>{-1e3, 1e3});
            text += " lower=\"" + decimal(limits[0] + notes.start) + "\" upper=\"" + decimal(limits[1] + notes.start) + "\"";
        }
        return text + " effort=\"" + decimal(notes.effort.value_or(unknown_effort)) + "\" velocity=\"" +
               decimal(notes.velocity.value_or(unknown_effort)) + "\"/>";
    }

    const core::scene::Scene& scene_;
    const core::model::Model& model_;
    const RobotNotes& notes_;
    std::string stem_;
    std::vector<Hanging> hanging_;
    std::vector<std::string> links_, carriers_;   // per body: its link, and the joint that it hangs from
    std::vector<std::vector<FrameNote>> frames_;  // per body
    std::map<std::string, Mimic> mimics_;         // by joint
    std::vector<std::string> unknown_efforts_, unlimited_slides_;
    std::unordered_map<std::string, int> index_of_;  // bodies by name
    core::files::UniqueNames files_{"_", true};
    ExportedRobot out_;
    Errors errors_;
};

}  // namespace

Result<ExportedRobot> robot_of_scene(const core::scene::Scene& scene, const core::model::Model& model, const RobotNotes& notes,
                                     const std::string& stem) {
    return RobotWriter(scene, model, notes, stem).write();
}

}  // namespace fettle::design::urdf
