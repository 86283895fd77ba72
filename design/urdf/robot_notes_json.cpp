// SPDX-License-Identifier: MIT
#include "design/urdf/robot_notes_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/units.hpp"
#include "core/files/json_document.hpp"
#include "core/scene/angles.hpp"

namespace fettle::design::urdf {

namespace {

using core::base::Dimension;
using core::files::JsonNode;
using Json = nlohmann::ordered_json;

BodyNotes read_body(const JsonNode& node, double unit) {
    BodyNotes notes;
    node.allow_keys({"colour", "frames"});
    const auto colour = node["colour"].numbers();
    if (colour && colour->size() == 4 && std::all_of(colour->begin(), colour->end(), [](double c) { return c >= 0 && c <= 1; })) {
        notes.colour = {(*colour)[0], (*colour)[1], (*colour)[2], (*colour)[3]};
    } else if (colour) {
        node["colour"].fail(ErrorCode::out_of_range, "four numbers from 0 to 1 are expected: red, green, blue and opacity");
    }
    for (const JsonNode& each : node["frames"].objects()) {
        each.allow_keys({"name", "joint", "position", "rotation_vector"});
        FrameNote frame;
        frame.name = each.require("name").string().value_or("");
        frame.joint = each["joint"].string().value_or(frame.name);
        frame.pose.position = each["position"].length3(unit).value_or(Vector3::Zero());
        const auto turn = each["rotation_vector"].quantity3(Dimension::angle, core::scene::radians(1));
        if (turn && turn->norm() > 0) frame.pose.rotation = Eigen::AngleAxisd(turn->norm(), turn->normalized()).toRotationMatrix();
        notes.frames.push_back(std::move(frame));
    }
    return notes;
}

JointNotes read_joint(const JsonNode& node, bool turns, double unit) {
    JointNotes notes;
    node.allow_keys({"start", "effort", "velocity"});
    notes.start = node["start"].quantity(turns ? Dimension::angle : Dimension::length, turns ? core::scene::radians(1) : unit).value_or(0);
    notes.effort = node["effort"].quantity(turns ? Dimension::torque : Dimension::force, 1, core::files::not_negative);
    notes.velocity = node["velocity"].quantity(turns ? Dimension::angular_speed : Dimension::speed, 1, core::files::not_negative);
    return notes;
}

Json three_of(const Vector3& x) { return {x[0], x[1], x[2]}; }

}  // namespace

Result<RobotNotes> read_robot_notes(const std::string& scene_path) {
    auto document = core::files::JsonDocument::read(scene_path);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    const auto unit = core::base::metres_per_unit(root["units"].string().value_or("m"));
    RobotNotes notes;
    for (const JsonNode& body : root["bodies"].elements())
        if (body.is_object() && body["urdf"].exists())
            notes.bodies[body["name"].string().value_or("")] = read_body(body["urdf"], unit ? *unit : 1);
    for (const JsonNode& joint : root["joints"].elements())
        if (joint.is_object() && joint["urdf"].exists())
            notes.joints[joint["name"].string().value_or("")] =
                read_joint(joint["urdf"], joint["type"].string() == "revolute", unit ? *unit : 1);
    if (!document->errors().empty()) return document->errors();
    return notes;
}

Json notes_json(const BodyNotes& notes) {
    Json out = Json::object();
    if (notes.colour) out["colour"] = *notes.colour;
    for (const FrameNote& frame : notes.frames) {
        Json entry{{"name", frame.name}, {"joint", frame.joint}, {"position", three_of(1e3 * frame.pose.position)}};
        const Eigen::AngleAxisd turn(frame.pose.rotation);
        if (turn.angle() != 0) entry["rotation_vector"] = three_of(180 / M_PI * turn.angle() * turn.axis());
        out["frames"].push_back(std::move(entry));
    }
    return out;
}

Json notes_json(const JointNotes& notes, bool turns) {
    Json out = Json::object();
    if (notes.start != 0) out["start"] = notes.start * (turns ? 180 / M_PI : 1e3);
    if (notes.effort) out["effort"] = *notes.effort;
    if (notes.velocity) out["velocity"] = *notes.velocity;
    return out;
}

}  // namespace fettle::design::urdf
