// SPDX-License-Identifier: MIT
#include "core/records/poses_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_document.hpp"
#include "core/files/json_keys.hpp"
#include "core/files/json_writer.hpp"
#include "core/records/poses_table.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;
using files::JsonDocument;
using files::JsonNode;
using kinematics::Pose;

constexpr double largest_turn_allowed = 170 * M_PI / 180;

std::string shown(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
}

void read_json_body(const JsonNode& node, std::size_t body, RotationForm form, double unit, PosesTable& table, base::Errors& errors) {
    const auto rows = node.elements();
    if (node.is_array() && rows.size() != table.times.size()) {
        node.fail(ErrorCode::inconsistent,
                  std::to_string(rows.size()) + " poses, " + std::to_string(table.times.size()) + " expected: one per time");
        return;
    }
    const auto count = 3 + static_cast<std::size_t>(number_count(form));
    for (std::size_t t = 0; t < rows.size(); ++t) {
        const auto numbers = rows[t].numbers();
        if (!numbers) continue;
        if (numbers->size() != count) {
            rows[t].fail(ErrorCode::inconsistent, std::to_string(numbers->size()) + " numbers, " + std::to_string(count) +
                                                      " expected: px py pz and the rotation as a " +
                                                      std::string(rotation_form_names()[static_cast<std::size_t>(form)]));
            continue;
        }
        const auto rotation = rotation_from_numbers(form, {numbers->begin() + 3, numbers->end()}, rows[t].where(), table, errors);
        if (!rotation) continue;
        PoseEntry entry{{*rotation, Vector3::Zero()}, rows[t].where()};
        for (int k = 0; k < 3; ++k) entry.pose.position[k] = files::in_metres((*numbers)[k], unit);
        table.entries[t][body] = entry;
    }
}

base::Result<PosesTable> read_poses_json(const std::string& path, const model::Model& model, std::optional<double> length_unit) {
    auto document = JsonDocument::read(path);
    if (!document) return document.errors();
    const JsonNode root = document->root();
    if (!files::is_format(root, "fettle_poses", "table of poses", 1)) return document->errors();
    root.allow_keys({"fettle_poses", "units", "rotation", "times", "bodies"});
    const JsonNode units = root.require("units");
    const auto unit_name = units.choice({"um", "mm", "cm", "m", "in", "ft"});
    const auto form_name = root.require("rotation").choice(rotation_form_names());
    PosesTable table;
    const JsonNode times = root.require("times");
    table.times = times.numbers().value_or(std::vector<double>{});
    if (times.is_array() && table.times.empty()) times.fail(ErrorCode::inconsistent, "at least one time is expected");
    base::Errors errors;
    if (!document->errors().empty()) return document->errors();
    const double unit = base::metres_per_unit(*unit_name).value();
    if (length_unit && *length_unit != unit)
        units.fail(ErrorCode::inconsistent, "another unit was asked for by --poses-unit; leave it out");
    for (std::size_t t = 0; t < table.times.size(); ++t) {
        table.time_where.push_back(times.where() + "/" + std::to_string(t));
        table.entries.emplace_back(model.bodies.size());
    }
    const auto& names = rotation_form_names();
    const auto form = static_cast<RotationForm>(std::find(names.begin(), names.end(), *form_name) - names.begin());
    for (const auto& [name, node] : root.require("bodies").members()) {
        if (const auto body = body_by_name(model, name, node.where(), errors))
            read_json_body(node, static_cast<std::size_t>(*body), form, unit, table, errors);
    }
    errors.insert(errors.begin(), document->errors().begin(), document->errors().end());
    if (!errors.empty()) return errors;
    return table;
}

base::Errors check_times(const PosesTable& table) {
    base::Errors errors;
    for (std::size_t t = 1; t < table.times.size(); ++t) {
        if (table.times[t] > table.times[t - 1]) continue;
        errors.push_back({ErrorCode::inconsistent, table.time_where[t],
                          "time " + shown(table.times[t]) + " does not come after " + shown(table.times[t - 1]) + "; times increase"});
    }
    return errors;
}

// The pose of the reference point, from that of the file's frame.
Pose of_reference_point(const Pose& file, const model::Body& body) {
    return {file.rotation, kinematics::world_position(file, body.reference_point)};
}

// Even times need no list: time_start and timestep say it all.
void set_times(const std::vector<double>& times, stepper::Trajectory& trajectory) {
    trajectory.time_start = times.front();
    const auto steps = static_cast<double>(times.size() - 1);
    if (steps == 0) return;
    trajectory.timestep = (times.back() - times.front()) / steps;
    for (std::size_t t = 0; t < times.size(); ++t) {
        const double even = trajectory.time_start + static_cast<double>(t) * trajectory.timestep;
        if (std::abs(times[t] - even) > 1e-9 * trajectory.timestep) {
            trajectory.times = times;
            return;
        }
    }
}

base::Result<PosesFile> assemble(const PosesTable& table, const model::Model& model) {
    PosesFile out;
    out.largest_rotation_error = table.largest_rotation_error;
    stepper::Trajectory& trajectory = out.trajectory;
    trajectory.timestep = model.timestep;
    set_times(table.times, trajectory);
    const std::size_t count = model.bodies.size();
    for (std::size_t b = 0; b < count; ++b) {
        trajectory.body_names.push_back(model.bodies[b].name);
        if (!table.entries.front()[b]) out.still.push_back(model.bodies[b].name);
    }
    base::Errors errors;
    for (std::size_t t = 0; t < table.times.size(); ++t) {
        trajectory.poses.emplace_back();
        for (std::size_t b = 0; b < count; ++b) {
            const auto& entry = table.entries[t][b];
            trajectory.poses.back().push_back(entry ? of_reference_point(entry->pose, model.bodies[b]) : model.bodies[b].pose_start);
        }
        if (t == 0) continue;
        stepper::TrajectoryStep step;
        step.nodes.resize(2);
        for (std::size_t b = 0; b < count; ++b) {
            const Pose &before = trajectory.poses[t - 1][b], &after = trajectory.poses[t][b];
            const bool same = before.rotation == after.rotation;
            const Vector3 theta = same ? Vector3::Zero().eval() : kinematics::rotation_vector(after.rotation * before.rotation.transpose());
            step.nodes[0].push_back({before.position, Vector3::Zero()});
            step.nodes[1].push_back({after.position, theta});
            const double turn = theta.norm();
            out.largest_turn = std::max(out.largest_turn.value_or(0), turn);
            out.largest_cut = std::max(out.largest_cut, 0.5 * (after.position - before.position).norm() * std::tan(turn / 4));
            if (turn > largest_turn_allowed)
                errors.push_back({ErrorCode::out_of_range, table.entries[t][b]->where,
                                  "body \"" + model.bodies[b].name + "\" turns by " + shown(turn * 180 / M_PI) + " degrees since time " +
                                      shown(table.times[t - 1]) +
                                      "; beyond 170 degrees it could have gone either way: write poses more often"});
        }
        trajectory.steps.push_back(std::move(step));
    }
    if (!errors.empty()) return errors;
    return out;
}

std::string shortest(double x) {
    char buffer[32];
    const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, x);
    FETTLE_ASSERT(code == std::errc() && std::isfinite(x), "a pose with a number that is not finite");
    return {buffer, end};
}

// px py pz and the matrix row by row, with commas between.
std::string pose_numbers(const Pose& pose, const model::Body& body, double unit) {
    const Vector3 position = kinematics::world_position(pose, -body.reference_point) / unit;
    std::string out = shortest(position.x()) + "," + shortest(position.y()) + "," + shortest(position.z());
    for (int i = 0; i < 9; ++i) out += "," + shortest(pose.rotation(i / 3, i % 3));
    return out;
}

bool is_json(const std::filesystem::path& path) { return path.extension() == ".json"; }

}  // namespace

base::Result<PosesFile> read_poses(const std::filesystem::path& path, const model::Model& model, std::optional<double> length_unit) {
    base::Result<PosesTable> table = base::Error{};
    if (is_json(path)) {
        table = read_poses_json(path.string(), model, length_unit);
    } else {
        const auto text = files::read_file(path);
        if (!text) return text.errors();
        table = read_poses_csv(*text, path.string(), model, length_unit);
    }
    if (!table) return table.errors();
    const base::Errors errors = check_times(*table);
    if (!errors.empty()) return errors;
    return assemble(*table, model);
}

base::Errors write_poses(const std::filesystem::path& path, const stepper::Trajectory& trajectory, const model::Model& model,
                         const std::string& unit) {
    FETTLE_ASSERT(!trajectory.poses.empty() && trajectory.poses.front().size() == model.bodies.size(),
                  "a trajectory of the model's bodies");
    const double metres = base::metres_per_unit(unit).value();
    const std::size_t count = trajectory.poses.size();
    files::NewFile file(path);
    const auto put = [&file](std::string& text) {
        if (text.size() < files::write_size) return;
        file.write(text);
        text.clear();
    };
    files::JsonWriter out;
    if (!is_json(path)) {
        out.text = "time,body";
        for (const char* column : {"px", "py", "pz"}) out.text += std::string(",") + column + "[" + unit + "]";
        out.text += ",r11,r12,r13,r21,r22,r23,r31,r32,r33\n";
        for (std::size_t t = 0; t < count; ++t) {
            for (std::size_t b = 0; b < model.bodies.size(); ++b) {
                out.text += shortest(stepper::time_at(trajectory, static_cast<int>(t))) + "," + base::csv_cell(model.bodies[b].name) + "," +
                            pose_numbers(trajectory.poses[t][b], model.bodies[b], metres) + "\n";
                put(out.text);
            }
        }
    } else {
        out.text = "{\"fettle_poses\": 1, \"units\": \"" + unit + "\", \"rotation\": \"matrix\",\n \"times\": ";
        out.list(count, ",", [&](std::size_t t) { out.text += shortest(stepper::time_at(trajectory, static_cast<int>(t))); });
        out.text += ",\n \"bodies\": {";
        for (std::size_t b = 0; b < model.bodies.size(); ++b) {
            out.key(model.bodies[b].name);
            out.list(count, ",\n    ", [&](std::size_t t) {
                out.text += "[" + pose_numbers(trajectory.poses[t][b], model.bodies[b], metres) + "]";
                put(out.text);
            });
        }
        out.text += "}}\n";
    }
    file.write(out.text);
    files::FilesTogether alone;
    base::Errors errors = alone.add(std::move(file));
    return errors.empty() ? alone.take_names() : errors;
}

bool is_poses_file(const std::filesystem::path& path) { return files::has_top_level_key(path, "fettle_poses"); }

}  // namespace fettle::core::records
