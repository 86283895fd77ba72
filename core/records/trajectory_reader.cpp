// SPDX-License-Identifier: MIT
#include "core/records/trajectory_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/rounding.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_document.hpp"
#include "core/model/body_geometry.hpp"
#include "core/records/checkpoint_io.hpp"
#include "core/records/geometry_hash.hpp"
#include "core/records/path_hash.hpp"
#include "core/records/trajectory_format.hpp"
#include "core/records/trajectory_header.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;
using files::JsonDocument;
using files::JsonNode;
using kinematics::ChartPoint;
using kinematics::Pose;

// Rounding of exp and a product (ccd/chord_deviation.hpp, rotated_rounding): what the end of a step's chart and the next pose, which is
// made orthonormal again, may differ by. Every certified bound is charged more than twice that.
double allowed_turn(const Vector3& theta) { return unit_roundoff * (80 + 10 * theta.norm()); }

class Reader {
public:
    explicit Reader(const std::string& path) { out_.path = path; }

    base::Result<StoredTrajectory> read(std::string_view text) {
        for (int number = 1; !text.empty(); ++number) {
            const std::size_t end = text.find('\n');
            const bool whole = end != std::string_view::npos;
            const std::string line(text.substr(0, end));
            text.remove_prefix(whole ? end + 1 : text.size());
            base::Errors errors = read_line(line, number);
            if (errors.empty()) continue;
            if (whole || number == 1 || errors.front().code != ErrorCode::parse) return errors;
            out_.warnings.push_back(out_.path + " ends in the middle of a line, as that of a run that was killed: the " +
                                    std::to_string(out_.trajectory.steps.size()) + " steps before it are taken");
        }
        if (!hash_) return base::Errors{{ErrorCode::parse, out_.path, "the file is empty"}};
        model::complete_geometry(out_.model.bodies);
        out_.model.end_time = stepper::time_at(out_.trajectory, count_of(out_.trajectory.steps));
        return std::move(out_);
    }

private:
    // A line that is at fault leaves no trace.
    base::Errors read_line(const std::string& line, int number) {
        auto document = JsonDocument::parse(line, out_.path + ":" + std::to_string(number));
        if (!document) return document.errors();
        const JsonNode root = document->root();
        if (number == 1) {
            read_trajectory_header(root, out_);
            if (document->errors().empty()) start_hash();
        } else if (root["checkpoint"].exists()) {
            root.allow_keys({"checkpoint"});
            StoredCheckpoint read = read_checkpoint(root["checkpoint"], out_.trajectory);
            if (document->errors().empty()) {
                out_.checkpoint = std::move(read.checkpoint);
                out_.checkpoint_scene = std::move(read.scene);
            }
        } else {
            read_step(root, *document);
        }
        return document->errors();
    }

    void start_hash() {
        const stepper::Trajectory& t = out_.trajectory;
        hash_.emplace(t.timestep, t.time_start, t.times, t.poses.front());
    }

    void read_step(const JsonNode& root, const JsonDocument& document) {
        root.allow_keys({"nodes", "fractions", "time", "poses", "hash"});
        stepper::TrajectoryStep step = read_nodes(root);
        const std::vector<Pose> poses = read_pose_list(root.require("poses"), out_.model.bodies.size());
        const std::optional<double> time = read_time(root);
        if (!document.errors().empty()) return;
        check_path(step, poses, root);
        PathHash hash = *hash_;
        hash.add_step(step, time ? &*time : nullptr, poses);
        const auto stored = root["hash"].string();
        if (stored && *stored != files::hexadecimal(hash.value()))
            root["hash"].fail(ErrorCode::inconsistent,
                              "it is not that of the path up to here (" + files::hexadecimal(hash.value()) + "): the file was changed");
        if (!document.errors().empty()) return;
        hash_ = hash;
        if (time) out_.trajectory.times.push_back(*time);
        out_.trajectory.steps.push_back(std::move(step));
        out_.trajectory.poses.push_back(poses);
    }

    std::optional<double> read_time(const JsonNode& root) const {
        const auto& times = out_.trajectory.times;
        if (times.empty()) {
            if (root["time"].exists())
                root["time"].fail(ErrorCode::inconsistent, "the first line has no time, so the steps are even and have none either");
            return std::nullopt;
        }
        const auto time = root.require("time").number(stored_numbers);
        if (time && !(*time > times.back()))
            root["time"].fail(ErrorCode::inconsistent,
                              "each step ends later than the one before: more than " + std::to_string(times.back()));
        return time;
    }

    stepper::TrajectoryStep read_nodes(const JsonNode& root) const {
        stepper::TrajectoryStep step;
        const JsonNode nodes = root.require("nodes");
        for (const JsonNode& node : nodes.elements()) step.nodes.push_back(read_node(node));
        if (nodes.is_array() && step.nodes.size() < 2) nodes.fail(ErrorCode::inconsistent, "a step has at least two nodes");
        const JsonNode fractions = root["fractions"];
        if (!fractions.exists()) return step;
        step.fractions = fractions.numbers().value_or(std::vector<double>{});
        const auto& f = step.fractions;
        if (f.size() != step.nodes.size() || f.size() < 2 || f.front() != 0 || f.back() != 1 || !std::is_sorted(f.begin(), f.end()))
            fractions.fail(ErrorCode::inconsistent, "one fraction per node is expected, from 0 to 1, none below the one before");
        return step;
    }

    std::vector<ChartPoint> read_node(const JsonNode& node) const {
        const auto entries = node.elements();
        std::vector<ChartPoint> points(out_.model.bodies.size());
        if (!has_entries(entries, points.size(), node, "six numbers per body")) return points;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const auto numbers = read_row(entries[i], 6, "px py pz rx ry rz");
            for (std::size_t k = 0; k < numbers.size(); ++k) (k < 3 ? points[i].position : points[i].rotation_vector)[k % 3] = numbers[k];
        }
        return points;
    }

    // What is certified is the path as stored: it must be one path, without jumps from step to step.
    void check_path(const stepper::TrajectoryStep& step, const std::vector<Pose>& poses, const JsonNode& root) const {
        for (std::size_t b = 0; b < poses.size(); ++b) {
            const Pose &before = out_.trajectory.poses.back()[b], &after = poses[b];
            const ChartPoint &first = step.nodes.front()[b], &last = step.nodes.back()[b];
            const Matrix3 reached = kinematics::rotation(last.rotation_vector) * before.rotation;
            const bool starts = first.rotation_vector == Vector3::Zero() && first.position == before.position;
            const bool ends =
                last.position == after.position && (reached - after.rotation).cwiseAbs().maxCoeff() <= allowed_turn(last.rotation_vector);
            if (starts && ends) continue;
            root["nodes"].fail(ErrorCode::inconsistent, "the path of body `" + out_.trajectory.body_names[b] + "` does not " +
                                                            (starts ? "end at the next pose" : "start at its pose with rotation vector 0"));
        }
    }

    StoredTrajectory out_;
    std::optional<PathHash> hash_;  // of what has been read
};

// Why a text that is one JSON document over many lines is no trajectory: a file of version 1 was one, and other kinds of files are.
// Nothing: it is no such document.
std::optional<base::Error> other_document(const std::string& path, std::string_view text) {
    auto document = JsonDocument::parse(std::string(text), path);
    if (!document) return std::nullopt;
    const JsonNode root = document->root();
    if (!root.is_object() || !root[format_key].exists())
        return base::Error{
            ErrorCode::missing_key, path,
            "is no trajectory: its first line has no `" + std::string(format_key) + "`; `fettle simulate SCENE --out DIR` writes one"};
    if (root[format_key].number() == 1)
        return base::Error{ErrorCode::unsupported, path,
                           "a trajectory of format version 1, which is no longer read; write it anew (`fettle simulate SCENE --out DIR`)"};
    return std::nullopt;
}

}  // namespace

base::Result<StoredTrajectory> parse_trajectory(const std::string& path, std::string_view text) {
    base::Result<StoredTrajectory> read = Reader(path).read(text);
    if (read) return read;
    if (const std::optional<base::Error> other = other_document(path, text)) return *other;
    return read;
}

}  // namespace fettle::core::records
