// SPDX-License-Identifier: MIT
#include "core/certificate/ideal_joints.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

#include "core/base/limits.hpp"

namespace fettle::core::certificate {
namespace {

using base::ErrorCode;
using base::is_usable_number;
using files::JsonNode;
using files::JsonWriter;
using measure::Measure;

const std::vector<std::string_view> measure_names{"offset", "product", "distance", "angle"};        // of MeasureKind
const std::vector<std::string_view> along_names{"a", "b", "world"};                                 // of OffsetAxis
const std::vector<std::string_view> curve_names{"linear", "cubic", "trapezoid", "control points"};  // of CurveKind

int place_of(const std::vector<std::string_view>& names, const JsonNode& node) {
    const std::string word = node.choice(names).value_or(std::string(names.front()));
    return static_cast<int>(std::find(names.begin(), names.end(), word) - names.begin());
}

bool is_one_of(int index, std::size_t count) { return index >= 0 && index < static_cast<int>(count); }

bool is_axis(int axis) { return axis >= 0 && axis < 3; }

bool is_usable_frame(const measure::Frame& frame, std::size_t bodies) {
    return (frame.body == measure::world || is_one_of(frame.body, bodies)) && frame.point.allFinite() && frame.axes.allFinite() &&
           is_usable_number(frame.point.norm()) && is_usable_number(frame.axes.norm());
}

bool is_usable_measure(const Measure& m, std::size_t frames) {
    return is_one_of(m.a, frames) && is_one_of(m.b, frames) && is_axis(m.axis_a) && is_axis(m.axis_b) &&
           m.kind != measure::MeasureKind::distance;
}

bool is_usable_curve(const scene::Curve& curve) {
    const auto usable = [](const std::vector<double>& list) { return std::all_of(list.begin(), list.end(), is_usable_number); };
    if (!usable(curve.times) || !usable(curve.values) || !is_usable_number(curve.rate)) return false;
    if (curve.stop_time && !is_usable_number(*curve.stop_time)) return false;
    for (std::size_t i = 1; i < curve.times.size(); ++i)
        if (!(curve.times[i] > curve.times[i - 1])) return false;
    if (curve.kind == scene::CurveKind::control_points && !curve.values.empty()) return curve.times.size() == 2 && curve.values.size() >= 4;
    return curve.times.size() == curve.values.size();
}

bool is_usable_row(const constraint::Row& row, std::size_t measures) {
    const auto usable = [&](const constraint::RowPart& part) { return is_one_of(part.measure, measures) && is_usable_number(part.factor); };
    return std::all_of(row.parts.begin(), row.parts.end(), usable) && is_usable_number(row.constant) && is_usable_curve(row.curve);
}

double deviation_of(const IdealJoints& joints, int body) {
    const auto found = std::lower_bound(joints.bodies.begin(), joints.bodies.end(), body);
    if (found == joints.bodies.end() || *found != body) return 0;
    const auto at = static_cast<std::size_t>(found - joints.bodies.begin());
    return at < joints.deviations.size() ? joints.deviations[at] : base::infinity;
}

void write_curve(JsonWriter& out, const scene::Curve& curve) {
    out.text += '{';
    out.key("kind");
    out.string(curve_names[static_cast<std::size_t>(curve.kind)]);
    out.key("rate");
    out.number(curve.rate);
    out.key("times");
    out.numbers(curve.times);
    out.key("values");
    out.numbers(curve.values);
    if (curve.stop_time) {
        out.key("stop_time");
        out.number(*curve.stop_time);
    }
    out.text += '}';
}

void write_row(JsonWriter& out, const constraint::Row& row) {
    out.text += '{';
    out.key("parts");
    out.list(row.parts.size(), ", ", [&](std::size_t i) {
        out.text += '{';
        out.key("measure");
        out.number(row.parts[i].measure);
        out.key("factor");
        out.number(row.parts[i].factor);
        out.text += '}';
    });
    out.key("constant");
    out.number(row.constant);
    out.key("curve");
    write_curve(out, row.curve);
    out.text += '}';
}

void write_measure(JsonWriter& out, const Measure& m) {
    out.text += '{';
    out.key("kind");
    out.string(measure_names[static_cast<std::size_t>(m.kind)]);
    out.key("a");
    out.number(m.a);
    out.key("b");
    out.number(m.b);
    out.key("axis_a");
    out.number(m.axis_a);
    out.key("axis_b");
    out.number(m.axis_b);
    out.key("along");
    out.string(along_names[static_cast<std::size_t>(m.offset_axis)]);
    out.text += '}';
}

void write_frame(JsonWriter& out, const measure::Frame& frame) {
    out.text += '{';
    out.key("body");
    out.number(frame.body);
    out.key("point");
    out.numbers(frame.point);
    out.key("axes");
    out.numbers(frame.axes.reshaped());
    out.text += '}';
}

measure::Frame read_frame(const JsonNode& node) {
    measure::Frame out;
    out.body = node.require("body").integer(measure::world).value_or(measure::world);
    out.point = node.require("point").vector3().value_or(Vector3(Vector3::Zero()));
    const JsonNode axes = node.require("axes");
    const auto numbers = axes.numbers().value_or(std::vector<double>(9, 0.0));
    if (numbers.size() == 9)
        out.axes = Eigen::Map<const Matrix3>(numbers.data());
    else
        axes.fail(ErrorCode::inconsistent, "nine numbers are expected");
    return out;
}

Measure read_measure(const JsonNode& node) {
    Measure out;
    out.kind = static_cast<measure::MeasureKind>(place_of(measure_names, node.require("kind")));
    out.a = node.require("a").integer(0).value_or(0);
    out.b = node.require("b").integer(0).value_or(0);
    out.axis_a = node.require("axis_a").integer(0, 2).value_or(0);
    out.axis_b = node.require("axis_b").integer(0, 2).value_or(0);
    out.offset_axis = static_cast<measure::OffsetAxis>(place_of(along_names, node.require("along")));
    return out;
}

constraint::Row read_row(const JsonNode& node) {
    constraint::Row out;
    for (const JsonNode& part : node.require("parts").elements())
        out.parts.push_back({part.require("measure").integer(0).value_or(0), part.require("factor").number().value_or(0)});
    out.constant = node.require("constant").number().value_or(0);
    const JsonNode curve = node.require("curve");
    out.curve.kind = static_cast<scene::CurveKind>(place_of(curve_names, curve.require("kind")));
    out.curve.rate = curve.require("rate").number().value_or(0);
    out.curve.times = curve.require("times").numbers().value_or(std::vector<double>{});
    out.curve.values = curve.require("values").numbers().value_or(std::vector<double>{});
    out.curve.stop_time = curve["stop_time"].number();
    return out;
}

}  // namespace

double joint_charge(const IdealJoints& joints, int a, int b) {
    return (deviation_of(joints, a) + deviation_of(joints, b)) * (1 + 4 * std::numeric_limits<double>::epsilon());
}

base::Errors check_joints(const IdealJoints& joints, std::size_t bodies) {
    base::Errors errors;
    const auto fault = [&](const std::string& where, const char* message) {
        errors.push_back({ErrorCode::out_of_range, "/joints/" + where, message});
    };
    const auto each = [&](const char* list, std::size_t count, const auto& usable, const char* message) {
        for (std::size_t i = 0; i < count; ++i)
            if (!usable(i)) fault(list + ("/" + std::to_string(i)), message);
    };
    each(
        "frames", joints.set.frames.size(), [&](std::size_t i) { return is_usable_frame(joints.set.frames[i], bodies); },
        "a body of the model or -1, and finite numbers are expected");
    each(
        "measures", joints.set.measures.size(),
        [&](std::size_t i) { return is_usable_measure(joints.set.measures[i], joints.set.frames.size()); },
        "an offset, product or angle of two of the frames is expected");
    each(
        "rows", joints.rows.size(), [&](std::size_t i) { return is_usable_row(joints.rows[i], joints.set.measures.size()); },
        "parts that are measures, finite numbers and a curve are expected");
    for (std::size_t i = 0; i < joints.bodies.size(); ++i)
        if (!is_one_of(joints.bodies[i], bodies) || (i > 0 && joints.bodies[i] <= joints.bodies[i - 1]))
            fault("bodies/" + std::to_string(i), "bodies of the model, increasing, are expected");
    if (joints.rows.size() != 6 * joints.bodies.size()) fault("rows", "six rows per body that they move are expected");
    if (joints.deviations.size() != joints.bodies.size()) fault("deviations", "one per body is expected");
    for (const double deviation : joints.deviations)
        if (!(deviation >= 0 && is_usable_number(deviation))) fault("deviations", "lengths of at least 0 are expected");
    return errors;
}

bool same_joints(const IdealJoints& x, const IdealJoints& y) {
    const auto written = [](IdealJoints joints) {
        joints.deviations.clear();
        JsonWriter out;
        write_joints(out, joints);
        return out.text;
    };
    return written(x) == written(y);
}

void write_joints(JsonWriter& out, const IdealJoints& joints) {
    out.text += '{';
    out.key("frames");
    out.list(joints.set.frames.size(), ",\n ", [&](std::size_t i) { write_frame(out, joints.set.frames[i]); });
    out.key("measures");
    out.list(joints.set.measures.size(), ",\n ", [&](std::size_t i) { write_measure(out, joints.set.measures[i]); });
    out.key("rows");
    out.list(joints.rows.size(), ",\n ", [&](std::size_t i) { write_row(out, joints.rows[i]); });
    out.key("bodies");
    out.numbers(joints.bodies);
    out.key("deviations");
    out.numbers(joints.deviations);
    out.text += '}';
}

IdealJoints read_joints(const JsonNode& node) {
    IdealJoints out;
    for (const JsonNode& frame : node.require("frames").elements()) out.set.frames.push_back(read_frame(frame));
    for (const JsonNode& m : node.require("measures").elements()) out.set.measures.push_back(read_measure(m));
    for (const JsonNode& row : node.require("rows").elements()) out.rows.push_back(read_row(row));
    for (const JsonNode& body : node.require("bodies").elements()) out.bodies.push_back(body.integer(0).value_or(0));
    out.deviations = node.require("deviations").numbers().value_or(std::vector<double>{});
    return out;
}

}  // namespace fettle::core::certificate
