// SPDX-License-Identifier: MIT
#include "core/scene_files/mechanism_reader.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include "core/scene/angles.hpp"
#include "core/scene/joint_kind.hpp"

namespace fettle::core::scene_files {
namespace {

using base::ErrorCode;
using files::JsonNode;

constexpr std::string_view force_keys[] = {"stiffness", "rest", "preload", "damping", "friction", "limits"};

// The unit of a coordinate's numbers.
struct CoordinateUnit {
    bool is_angle = false;
    double length = 1;
    double number() const { return is_angle ? scene::radians(1) : length; }
    std::optional<double> read(const JsonNode& node) const {
        return node.quantity(is_angle ? base::Dimension::angle : base::Dimension::length, number());
    }
    std::optional<double> read_rate(const JsonNode& node) const {
        return node.quantity(is_angle ? base::Dimension::angular_speed : base::Dimension::speed, number());
    }
    std::optional<double> read_effort(const JsonNode& node, const files::NumberRange& range = files::any_number) const {
        return node.quantity(is_angle ? base::Dimension::torque : base::Dimension::force, 1, range);
    }
    std::optional<double> read_stiffness(const JsonNode& node) const {
        return node.quantity(is_angle ? base::Dimension::angular_stiffness : base::Dimension::stiffness, 1, files::not_negative);
    }
};

// A body's file frame at the start, as numbers that may follow from variables: world = rotation x + position.
struct Frame {
    std::array<Number3, 3> rotation{Number3{1, 0, 0}, Number3{0, 1, 0}, Number3{0, 0, 1}};  // rows
    Number3 position{0, 0, 0};

    // Points with w = 1, directions with w = 0.
    Number3 to_world(const Number3& x, double w) const {
        Number3 out;
        for (std::size_t i = 0; i < 3; ++i)
            out[i] = rotation[i][0] * x[0] + rotation[i][1] * x[1] + rotation[i][2] * x[2] + w * position[i];
        return out;
    }
    Number3 from_world(const Number3& x, double w) const {
        const Number3 d{x[0] - w * position[0], x[1] - w * position[1], x[2] - w * position[2]};
        Number3 out;
        for (std::size_t i = 0; i < 3; ++i) out[i] = rotation[0][i] * d[0] + rotation[1][i] * d[1] + rotation[2][i] * d[2];
        return out;
    }
};

bool is_constant(const Number3& x) {
    return std::all_of(x.begin(), x.end(), [](const expression::Number& number) { return number.is_constant(); });
}

class MechanismReader {
public:
    MechanismReader(double unit, const std::vector<scene::Body>& bodies, SceneFormulas& formulas)
        : unit_(unit), bodies_(bodies), formulas_(formulas) {
        for (const scene::Body& body : bodies) body_names_.push_back(body.name);
    }

    scene::Mechanism read(const JsonNode& root) {
        body_nodes_ = root["bodies"].elements();
        for (const JsonNode& node : root["joints"].elements()) read_joint(node);
        for (const JsonNode& node : root["springs"].elements()) read_spring(node, true);
        for (const JsonNode& node : root["dampers"].elements()) read_spring(node, false);
        for (const JsonNode& node : root["motors"].elements()) read_motor(node);
        for (const JsonNode& node : root["loads"].elements()) read_load(node);
        return std::move(out_);
    }

private:
    static std::vector<std::string_view> with_forces(std::vector<std::string_view> keys) {
        keys.insert(keys.end(), std::begin(force_keys), std::end(force_keys));
        return keys;
    }

    // One set of names for all, so that a message or a report means one thing.
    std::string read_name(const JsonNode& node) {
        const JsonNode name = node.require("name");
        std::string out = name.string().value_or("");
        if (!name.is_string()) return out;
        if (out.empty())
            name.fail(ErrorCode::out_of_range, "a name is not empty");
        else if (!names_.insert(out).second)
            name.fail(ErrorCode::inconsistent, name.shown() + " is the name of another joint, spring, damper, motor or load already");
        return out;
    }

    std::string read_choice(const JsonNode& node, const std::vector<std::string>& names, const std::string& what) {
        std::vector<std::string_view> allowed(names.begin(), names.end());
        if (allowed.empty() && node.exists()) {
            node.fail(ErrorCode::inconsistent, "no " + what + " is called " + node.shown() + ": this scene has none");
            return {};
        }
        return node.choice(allowed).value_or("");
    }

    kinematics::Pose pose_of(const std::string& body) const {
        for (const scene::Body& b : bodies_)
            if (b.name == body) return b.pose;
        return {};
    }

    // A body's file frame: the numbers of its node, with what they follow from.
    Frame frame_of(const std::string& body) const {
        Frame frame;
        for (const scene::Body& b : bodies_) {
            if (b.name != body) continue;
            const Matrix3 rotation = b.pose.rotation;
            for (Eigen::Index i = 0; i < 3; ++i)
                for (Eigen::Index k = 0; k < 3; ++k) frame.rotation[i][k] = rotation(i, k);
            for (const JsonNode& node : body_nodes_) {
                if (node.where() != b.where) continue;
                frame.position = formulas_.vector(node["position"], b.pose.position);
                const bool is_vector = b.orientation.kind == scene::Orientation::Kind::vector;
                const Number3 numbers = formulas_.vector(node[is_vector ? "rotation_vector" : "rotation"], b.orientation.numbers);
                if (!is_constant(numbers)) frame.rotation = is_vector ? rotation_of_vector(numbers) : rotation_of_angles(numbers);
                return frame;
            }
            for (Eigen::Index k = 0; k < 3; ++k) frame.position[k] = b.pose.position[k];
        }
        return frame;
    }

    // Three numbers of a joint or spring; `value` takes their values, if a formula is in them.
    void bind(const JsonNode& node, const std::string& key, const Number3& numbers, Vector3& value) {
        if (is_constant(numbers)) return;
        for (std::size_t k = 0; k < 3; ++k) {
            value[k] = numbers[k].value;
            formulas_.bind(node.pointer() + "/" + key + "/" + std::to_string(k), numbers[k]);
        }
    }

    // `a` (absent: the world) and `b`; where each end is: in its own frame, or where the other is at the start, or both at a place of the
    // world.
    void read_ends(const JsonNode& node, bool with_axis, scene::Attachment& a, scene::Attachment& b) {
        if (node["a"].exists()) a.body = read_choice(node["a"], body_names_, "body");
        if (node["b"].exists()) b.body = read_choice(node["b"], body_names_, "body");
        if (!node["a"].exists() && !node["b"].exists())
            node.fail(ErrorCode::missing_key, "`a` and `b` are expected, bodies; or one of them, for the world");
        if (a.body == b.body && !a.body.empty()) node["b"].fail(ErrorCode::inconsistent, "`a` and `b` are the same body");
        const kinematics::Pose pose_a = pose_of(a.body), pose_b = pose_of(b.body);
        const auto place = [&](const JsonNode& from) { return from.length3(unit_); };
        const auto direction = [&](const JsonNode& from) {
            const auto v = from.vector3();
            if (v && !(v->norm() > 0)) from.fail(ErrorCode::out_of_range, "an axis needs a length greater than 0");
            return v;
        };
        const auto to_world = [](const kinematics::Pose& pose, const Vector3& x, double w) {
            return Vector3(pose.rotation * x + w * pose.position);
        };
        const auto from_world = [](const kinematics::Pose& pose, const Vector3& x, double w) {
            return Vector3(pose.rotation.transpose() * (x - w * pose.position));
        };
        const Frame frame_a = frame_of(a.body), frame_b = frame_of(b.body);
        const auto read_pair = [&](const std::string& key, double w, const auto& read, Vector3& at_a, Vector3& at_b) {
            const auto both = read(node[key]), own_a = read(node[key + "_a"]), own_b = read(node[key + "_b"]);
            if (node[key].exists() && (node[key + "_a"].exists() || node[key + "_b"].exists()))
                node.fail(ErrorCode::inconsistent,
                          "either `" + key + "`, in the world at the start, or `" + key + "_a` and `" + key + "_b`, in the bodies' frames");
            if (!both && !own_a && !own_b) {
                if (!node[key].exists() && !node[key + "_a"].exists() && !node[key + "_b"].exists())
                    node.fail(ErrorCode::missing_key, "`" + key + "` is expected, in the world at the start; or `" + key + "_a` and `" +
                                                          key + "_b`, in the bodies' frames");
                return;
            }
            const Vector3 world = both ? *both : own_a ? to_world(pose_a, *own_a, w) : to_world(pose_b, *own_b, w);
            at_a = own_a ? *own_a : from_world(pose_a, world, w);
            at_b = own_b ? *own_b : from_world(pose_b, world, w);
            // What is computed of formulas is one too.
            Number3 world_numbers = formulas_.vector(node[key], world);
            if (!both && own_a) world_numbers = frame_a.to_world(formulas_.vector(node[key + "_a"], *own_a), w);
            if (!both && !own_a) world_numbers = frame_b.to_world(formulas_.vector(node[key + "_b"], *own_b), w);
            if (!own_a) bind(node, key + "_a", frame_a.from_world(world_numbers, w), at_a);
            if (!own_b) bind(node, key + "_b", frame_b.from_world(world_numbers, w), at_b);
            if (both) formulas_.use(node[key]);
        };
        read_pair("point", 1, place, a.point, b.point);
        if (with_axis) read_pair("axis", 0, direction, a.axis, b.axis);
    }

    scene::CoordinateForces read_forces(const JsonNode& node, const CoordinateUnit& unit) {
        scene::CoordinateForces out;
        out.stiffness = unit.read_stiffness(node["stiffness"]).value_or(0);
        out.rest = unit.read(node["rest"]);
        out.preload = unit.read_effort(node["preload"]).value_or(0);
        out.damping = node["damping"].number(files::not_negative).value_or(0);
        out.friction = unit.read_effort(node["friction"], files::not_negative).value_or(0);
        for (const char* key : {"rest", "preload"})
            if (node[key].exists() && !(out.stiffness > 0))
                node[key].fail(ErrorCode::inconsistent,
                               std::string("`") + key + "` needs a spring: a `stiffness` greater than 0 is expected");
        if (out.rest && node["preload"].exists())
            node["preload"].fail(ErrorCode::inconsistent, "either `rest` or `preload`: one follows from the other");
        const JsonNode limits = node["limits"];
        if (!limits.exists()) return out;
        const std::vector<JsonNode> ends = limits.elements();
        if (limits.is_array() && ends.size() != 2)
            limits.fail(ErrorCode::wrong_type, "two numbers are expected, the least and the greatest");
        if (ends.size() != 2) return out;
        const auto low = unit.read(ends[0]), high = unit.read(ends[1]);
        if (low && high && !(*low < *high)) limits.fail(ErrorCode::out_of_range, "the first limit must be less than the second");
        if (low && high) out.limits = {*low, *high};
        return out;
    }

    void read_joint(const JsonNode& node) {
        if (!node.is_object()) {
            node.allow_keys({});
            return;
        }
        scene::Joint joint;
        joint.where = node.where();
        joint.name = read_name(node);
        std::vector<std::string_view> names;
        for (const scene::JointKindInfo& info : scene::joint_kinds()) names.push_back(info.name);
        const auto kind = node.require("type").choice(names);
        if (!kind) return;
        joint.kind = static_cast<scene::JointKind>(std::find(names.begin(), names.end(), *kind) - names.begin());
        if (scene::couples_joints(joint.kind))
            read_coupling(node, joint);
        else
            read_lower_pair(node, joint);
        joint_names_.push_back(joint.name);
        out_.joints.push_back(std::move(joint));
    }

    static const scene::JointKindInfo& info_of(scene::JointKind kind) { return scene::joint_kinds()[static_cast<std::size_t>(kind)]; }
    static bool has_coordinate(scene::JointKind kind) { return !info_of(kind).coordinate.empty(); }

    static std::vector<std::string_view> keys_of(scene::JointKind kind) {
        std::vector<std::string_view> keys{"name", "type"};
        keys.insert(keys.end(), info_of(kind).keys.begin(), info_of(kind).keys.end());
        if (kind == scene::JointKind::revolute || kind == scene::JointKind::prismatic) keys.push_back("urdf");
        return has_coordinate(kind) ? with_forces(keys) : keys;
    }

    CoordinateUnit unit_of(scene::JointKind kind) const {
        return {kind == scene::JointKind::revolute || kind == scene::JointKind::screw, unit_};
    }

    void read_lower_pair(const JsonNode& node, scene::Joint& joint) {
        const bool is_ball = joint.kind == scene::JointKind::ball;
        const bool has_axis = is_ball ? has_swing(node) : joint.kind != scene::JointKind::fixed;
        node.allow_keys(keys_of(joint.kind));
        read_ends(node, has_axis, joint.a, joint.b);
        if (!has_axis) joint.b.axis = pose_of(joint.b.body).rotation.transpose() * (pose_of(joint.a.body).rotation * joint.a.axis);
        if (is_ball && has_axis) joint.swing = read_swing(node["swing"]);
        if (joint.kind == scene::JointKind::screw) joint.pitch = node.require("pitch").length(unit_).value_or(0);
        if (has_coordinate(joint.kind)) joint.forces = read_forces(node, unit_of(joint.kind));
        joint.collide = node["collide"].boolean().value_or(false);
        node["urdf"].members();  // what nothing here uses: read where a robot description is written
        if (node["assemble"].exists()) joint.assemble = read_assemble(node["assemble"]);
    }

    // A ball joint has an axis for the sake of its swing alone.
    static bool has_swing(const JsonNode& node) {
        if (node["swing"].exists()) return true;
        for (const char* key : {"axis", "axis_a", "axis_b"})
            if (node[key].exists())
                node[key].fail(ErrorCode::inconsistent,
                               "of a ball joint an axis is that of its `swing`, which is missing: say how far its "
                               "bodies may swing, for instance \"swing\": \"30deg\", or leave the axis out");
        return false;
    }

    std::optional<double> read_swing(const JsonNode& node) const {
        const std::optional<double> swing = CoordinateUnit{true, unit_}.read(node);
        if (swing && !(*swing > 0 && *swing < std::numbers::pi))
            node.fail(ErrorCode::out_of_range, "more than 0 and less than 180 degrees is expected");
        return swing;
    }

    // The joints that it names may come later in the list: the model looks for them (model/branch_of_joint.hpp).
    static scene::Assemble read_assemble(const JsonNode& node) {
        static constexpr std::string_view sides[] = {"left", "right", "ahead", "behind"};  // in the order of AssembleSide
        scene::Assemble out;
        node.allow_keys({"side", "from", "to"});
        if (!node.is_object()) return out;
        const std::vector<std::string_view> names(std::begin(sides), std::end(sides));
        const auto side = node.require("side").choice(names);
        if (side) out.side = static_cast<scene::AssembleSide>(std::find(names.begin(), names.end(), *side) - names.begin());
        out.from = node["from"].string().value_or("");
        out.to = node["to"].string().value_or("");
        return out;
    }

    void read_coupling(const JsonNode& node, scene::Joint& joint) {
        const bool gear = joint.kind == scene::JointKind::gear;
        node.allow_keys(keys_of(joint.kind));
        const std::vector<JsonNode> of = node.require("of").elements();
        if (of.size() == 2)
            for (std::size_t k = 0; k < 2; ++k) joint.of[k] = read_choice(of[k], joint_names_, "joint before this one");
        else if (node["of"].is_array())
            node["of"].fail(ErrorCode::wrong_type, "the names of two joints are expected");
        if (!gear) {
            joint.ratio = node.require("radius").length(unit_).value_or(1);
        } else if (node["teeth"].exists()) {
            read_teeth(node, joint);
        } else {
            joint.ratio = node.require("ratio").number().value_or(1);
        }
        if (joint.ratio == 0) node.fail(ErrorCode::out_of_range, gear ? "the ratio must not be 0" : "the radius must not be 0");
    }

    // N_a angle_a + N_b angle_b = constant.
    static void read_teeth(const JsonNode& node, scene::Joint& joint) {
        if (node["ratio"].exists()) node["ratio"].fail(ErrorCode::inconsistent, "either `teeth` or `ratio`, not both");
        const auto teeth = node["teeth"].numbers().value_or(std::vector<double>{});
        if (teeth.size() != 2 || teeth[0] == 0 || teeth[1] == 0)
            node["teeth"].fail(ErrorCode::out_of_range, "two numbers of teeth are expected, not 0; negative for a gear with teeth inside");
        else
            joint.ratio = -teeth[0] / teeth[1];
    }

    const scene::Joint* find_joint(const std::string& name) const {
        for (const scene::Joint& joint : out_.joints)
            if (joint.name == name) return &joint;
        return nullptr;
    }

    // The unit of a joint's coordinate, by the joint's name; a length where there is no such joint.
    CoordinateUnit unit_at(const std::string& joint) const {
        const scene::Joint* found = find_joint(joint);
        return found ? unit_of(found->kind) : CoordinateUnit{false, unit_};
    }

    void read_spring(const JsonNode& node, bool is_spring) {
        scene::Spring spring;
        spring.where = node.where();
        std::vector<std::string_view> keys{"name", "joint", "a", "b", "point", "point_a", "point_b", "damping"};
        node.allow_keys(is_spring ? with_forces(keys) : keys);
        if (!node.is_object()) return;
        spring.name = read_name(node);
        if (node["joint"].exists()) {
            spring.joint = read_choice(node["joint"], joint_names_, "joint");
            for (const char* key : {"a", "b", "point", "point_a", "point_b"})
                if (node[key].exists())
                    node[key].fail(ErrorCode::inconsistent,
                                   std::string("either `joint` or `") + key + "`: a spring acts on a joint, or between two points");
        } else {
            read_ends(node, false, spring.a, spring.b);
        }
        spring.forces = read_forces(node, unit_at(spring.joint));
        if (is_spring && !(spring.forces.stiffness > 0) && !spring.forces.limits) node.require("stiffness");
        if (!is_spring) node.require("damping");
        out_.springs.push_back(std::move(spring));
    }

    scene::Curve read_curve(const JsonNode& node, const auto& amount, const auto& rate) const {
        scene::Curve curve;
        if (!node.is_object()) {
            curve.times = {0};
            curve.values = {amount(node).value_or(0)};
            formulas_.bind(node.pointer() + "/values/0", formulas_.number(node, curve.values[0]));
            formulas_.use(node);
            return curve;
        }
        node.allow_keys({"rate", "times", "values", "stop_time", "profile"});
        static const std::vector<std::string_view> kinds{"linear", "cubic", "trapezoid", "control_points"};
        const std::string kind = node["profile"].choice(kinds).value_or("linear");
        curve.kind = static_cast<scene::CurveKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
        curve.rate = rate(node["rate"]).value_or(0);
        curve.stop_time = node["stop_time"].number(files::not_negative);
        curve.times = node["times"].numbers().value_or(std::vector<double>{});
        for (const JsonNode& value : node["values"].elements()) curve.values.push_back(amount(value).value_or(0));
        const bool spline = curve.kind == scene::CurveKind::control_points;
        if (spline && (curve.times.size() != 2 || curve.values.size() < 4))
            node.fail(ErrorCode::inconsistent, "`control_points` take two `times`, the first and the last, and at least 4 `values`");
        else if (!spline && curve.times.size() != curve.values.size())
            node.fail(ErrorCode::inconsistent, std::to_string(curve.times.size()) + " `times` for " + std::to_string(curve.values.size()) +
                                                   " `values`; one value for each time is expected");
        for (std::size_t i = 1; i < curve.times.size(); ++i)
            if (!(curve.times[i] > curve.times[i - 1]))
                node["times"].elements()[i].fail(ErrorCode::out_of_range, "times must increase from entry to entry");
        return curve;
    }

    void read_motor(const JsonNode& node) {
        node.allow_keys({"name", "joint", "angle", "travel", "speed", "torque", "force"});
        if (!node.is_object()) return;
        scene::Motor motor;
        motor.where = node.where();
        motor.name = read_name(node);
        motor.joint = read_choice(node.require("joint"), joint_names_, "joint");
        const CoordinateUnit unit = unit_at(motor.joint);
        const auto amount = [&](const JsonNode& n) { return unit.read(n); };
        const auto rate = [&](const JsonNode& n) { return unit.read_rate(n); };
        const auto effort = [&](const JsonNode& n) { return unit.read_effort(n); };
        const auto effort_rate = [](const JsonNode& n) { return n.number(); };
        const char *motion = unit.is_angle ? "angle" : "travel", *push = unit.is_angle ? "torque" : "force";
        if (motor.joint.empty()) return;  // which is told
        int given = 0;
        for (const char* key : {"angle", "travel", "speed", "torque", "force"}) given += node[key].exists() ? 1 : 0;
        const bool fits = node[motion].exists() || node["speed"].exists() || node[push].exists();
        if (given != 1 || !fits) {
            node.fail(ErrorCode::inconsistent,
                      std::string("one of `") + motion + "`, `speed` and `" + push + "` is expected for `" + motor.joint + "`");
            return;
        }
        if (node[motion].exists()) motor.curve = read_curve(node[motion], amount, rate);
        if (node["speed"].exists()) motor.curve.rate = unit.read_rate(node["speed"]).value_or(0);
        if (node[push].exists()) {
            motor.kind = scene::MotorKind::effort;
            motor.curve = read_curve(node[push], effort, effort_rate);
        }
        out_.motors.push_back(std::move(motor));
    }

    void read_load(const JsonNode& node) {
        node.allow_keys({"name", "body", "point", "force"});
        if (!node.is_object()) return;
        scene::PointLoad load;
        load.where = node.where();
        load.name = read_name(node);
        load.body = read_choice(node.require("body"), body_names_, "body");
        load.point = node.require("point").length3(unit_).value_or(Vector3::Zero());
        load.force = node.require("force").quantity3(base::Dimension::force, 1).value_or(Vector3::Zero());
        out_.loads.push_back(std::move(load));
    }

    double unit_;
    const std::vector<scene::Body>& bodies_;
    SceneFormulas& formulas_;
    std::vector<JsonNode> body_nodes_;  // of the file
    std::vector<std::string> body_names_, joint_names_;
    std::set<std::string> names_;
    scene::Mechanism out_;
};

}  // namespace

scene::Mechanism read_mechanism(const JsonNode& root, double unit, const std::vector<scene::Body>& bodies, SceneFormulas& formulas) {
    return MechanismReader(unit, bodies, formulas).read(root);
}

}  // namespace fettle::core::scene_files
