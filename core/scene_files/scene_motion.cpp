// SPDX-License-Identifier: MIT
#include "core/scene_files/scene_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/angles.hpp"

namespace fettle::core::scene_files {
namespace {

using base::ErrorCode;

const std::vector<std::string_view> dof_names{"px", "py", "pz", "rx", "ry", "rz"};

std::size_t dof_index(const std::string& name) {
    return static_cast<std::size_t>(std::find(dof_names.begin(), dof_names.end(), name) - dof_names.begin());
}

scene::MotionCurve read_curve(const files::JsonNode& node, double unit, bool is_angle) {
    scene::MotionCurve curve;
    using enum base::Dimension;
    const double si = is_angle ? scene::radians(1) : unit;
    const auto amount = [&](const files::JsonNode& n) { return n.quantity(is_angle ? angle : length, si).value_or(0); };
    node.allow_keys({"rate", "times", "values", "stop_time"});
    if (!node.is_object()) return curve;
    curve.rate = node["rate"].quantity(is_angle ? angular_speed : speed, si).value_or(0);
    curve.stop_time = node["stop_time"].number(files::not_negative);
    curve.times = node["times"].numbers().value_or(std::vector<double>{});
    for (const files::JsonNode& value : node["values"].elements()) curve.values.push_back(amount(value));
    if (curve.times.size() != curve.values.size()) {
        node.fail(ErrorCode::inconsistent, std::to_string(curve.times.size()) + " `times` for " + std::to_string(curve.values.size()) +
                                               " `values`; one value for each time is expected");
        return scene::MotionCurve{};
    }
    for (std::size_t i = 1; i < curve.times.size(); ++i) {
        if (curve.times[i] > curve.times[i - 1]) continue;
        node["times"].elements()[i].fail(ErrorCode::out_of_range, "times must increase from entry to entry");
    }
    if (scene::motion_value(curve, 0) != 0) {
        node["values"].fail(ErrorCode::inconsistent, "values are measured from the start pose, so the value at time 0 must be 0");
    }
    return curve;
}

void read_prescribed(const files::JsonNode& node, double unit, scene::Body& body) {
    if (node.exists() && body.type == scene::BodyType::static_body) {
        node.fail(ErrorCode::inconsistent, "a static body does not move; make it kinematic");
        return;
    }
    if (node.exists()) node.allow_keys(dof_names);
    for (const auto& [name, curve] : node.members()) {
        const std::size_t dof = dof_index(name);
        if (dof == 6) continue;
        if (body.prescribed[dof]) curve.fail(ErrorCode::inconsistent, "`" + name + "` is both `fixed` and `prescribed`");
        body.prescribed[dof] = read_curve(curve, unit, dof >= 3);
    }
}

/// The shorter way round is meant, and half a turn has none.
bool turns_by_half(const kinematics::Pose& from, const kinematics::Pose& to) {
    constexpr double room = 1e-6;
    return kinematics::rotation_vector(to.rotation * from.rotation.transpose()).norm() > std::numbers::pi - room;
}

void read_damping(const files::JsonNode& node, scene::Body& body) {
    if (!node.exists()) return;
    if (node.is_object()) {
        node.allow_keys({"linear", "angular"});
        body.damping = {node["linear"].number(files::not_negative).value_or(0), node["angular"].number(files::not_negative).value_or(0)};
    } else {
        const double rate = node.number(files::not_negative).value_or(0);
        body.damping = {rate, rate};
    }
}

void read_script(const files::JsonNode& node, double unit, scene::Body& body) {
    if (node.exists() && body.type != scene::BodyType::kinematic_body) {
        node.fail(ErrorCode::inconsistent, "only a kinematic body has a `script`");
        return;
    }
    kinematics::Pose before = body.pose;
    double time_before = 0;
    for (const files::JsonNode& entry : node.elements()) {
        entry.allow_keys({"time", "position", "rotation", "rotation_vector"});
        if (!entry.is_object()) continue;
        const auto time = entry.require("time").number();
        if (time && !(*time > time_before)) {
            entry["time"].fail(ErrorCode::out_of_range, entry["time"].shown() + " is not after the pose before it; the first is after 0");
        }
        const kinematics::Pose pose = read_pose(entry, unit, before).pose;
        if (turns_by_half(before, pose)) {
            entry.fail(ErrorCode::out_of_range,
                       "turns by half a turn from the pose before it, which can be done in two ways; put a pose between them");
        }
        time_before = time.value_or(time_before);
        before = pose;
        body.script.times.push_back(time_before);
        body.script.poses.push_back(pose);
    }
}

}  // namespace

WrittenPose read_pose(const files::JsonNode& node, double unit, const kinematics::Pose& otherwise) {
    WrittenPose out{otherwise, {}};
    out.pose.position = node["position"].length3(unit).value_or(otherwise.position);
    const files::JsonNode angles = node["rotation"], vector = node["rotation_vector"];
    if (angles.exists() && vector.exists()) node.fail(ErrorCode::inconsistent, "either `rotation` or `rotation_vector`, not both");
    const auto numbers = (vector.exists() ? vector : angles).quantity3(base::Dimension::angle, scene::radians(1));
    if (!numbers) return out;
    out.orientation = {vector.exists() ? scene::Orientation::Kind::vector : scene::Orientation::Kind::angles, *numbers};
    const std::vector<files::JsonNode> written = vector.exists() ? std::vector<files::JsonNode>() : angles.elements();
    const bool in_degrees = !written.empty() && std::all_of(written.begin(), written.end(), [](const auto& n) { return n.is_number(); });
    out.pose.rotation = in_degrees ? scene::rotation_from_degrees(*angles.vector3()) : scene::rotation_of(out.orientation);
    return out;
}

void read_motion(const files::JsonNode& node, double unit, scene::Body& body) {
    const bool dynamic = body.type == scene::BodyType::dynamic_body;
    for (const char* key : {"linear_velocity", "angular_velocity", "force", "torque", "damping", "fixed"}) {
        if (dynamic || !node[key].exists()) continue;
        const bool kinematic = body.type == scene::BodyType::kinematic_body;
        node[key].fail(ErrorCode::inconsistent, std::string("only a dynamic body has `") + key + "`" +
                                                    (kinematic ? "; a kinematic one moves as its `script` and `prescribed` say" : ""));
    }
    using enum base::Dimension;
    body.linear_velocity = node["linear_velocity"].quantity3(speed, unit).value_or(Vector3::Zero());
    body.angular_velocity = node["angular_velocity"].quantity3(angular_speed, scene::radians(1)).value_or(Vector3::Zero());
    body.force = node["force"].quantity3(force, 1).value_or(Vector3::Zero());
    body.torque = node["torque"].quantity3(torque, 1).value_or(Vector3::Zero());
    read_damping(node["damping"], body);
    for (const files::JsonNode& entry : node["fixed"].elements()) {
        if (const auto name = entry.choice(dof_names)) body.prescribed[dof_index(*name)] = scene::MotionCurve{};
    }
    read_prescribed(node["prescribed"], unit, body);
    for (auto& dof : body.prescribed) {
        if (!dynamic && !dof) dof = scene::MotionCurve{};
    }
    read_script(node["script"], unit, body);
}

}  // namespace fettle::core::scene_files
