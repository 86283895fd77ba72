// SPDX-License-Identifier: MIT
#include "design/exports/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"

namespace fettle::design::exports {

namespace {

using core::kinematics::ChartPoint;
using core::kinematics::Pose;
using core::stepper::Trajectory;

constexpr double slerp_error = 1e-6;  // of a rotation between two keyframes [rad]
constexpr double largest_turn = 0.5;  // between two keyframes [rad]: far from where the shorter way is the other one
constexpr int most_pieces = 256;

// The chart's path from r0 to r0 + d leaves the great circle between its ends by about |r0 x d| / 8.
int pieces_of(const ChartPoint& from, const ChartPoint& to) {
    const Vector3 d = to.rotation_vector - from.rotation_vector;
    const double bend = from.rotation_vector.cross(d).norm() / 8;
    const double wanted = std::max(d.norm() / largest_turn, std::sqrt(bend / slerp_error));
    return wanted < most_pieces ? std::max(1, static_cast<int>(std::ceil(wanted))) : most_pieces;  // of NaN too
}

void add_step(const Trajectory& trajectory, int t, Assembly& out) {
    const int segments = core::stepper::segment_count(trajectory, t), bodies = count_of(out.parts);
    const auto& nodes = trajectory.steps[t].nodes;
    for (int k = 0; k < segments; ++k) {
        const auto &from = nodes[k], &to = nodes[static_cast<std::size_t>(k) + 1];
        int pieces = 1;
        for (std::size_t b = 0; b < from.size(); ++b) pieces = std::max(pieces, pieces_of(from[b], to[b]));
        for (int j = 1; j <= pieces; ++j) {
            const bool last = k + 1 == segments && j == pieces;
            Keyframe key{core::stepper::time_at(trajectory, t, k, static_cast<double>(j) / pieces), last};
            if (last) {
                key.poses = trajectory.poses[static_cast<std::size_t>(t) + 1];
            } else {
                for (int b = 0; b < bodies; ++b)
                    key.poses.push_back(core::stepper::pose_at(trajectory, t, k, static_cast<double>(j) / pieces, b));
            }
            out.keyframes.push_back(std::move(key));
        }
    }
}

bool same(const Pose& a, const Pose& b) { return a.rotation == b.rotation && a.position == b.position; }

}  // namespace

Assembly assembly_of(const core::model::Model& model, const Trajectory& trajectory) {
    FETTLE_ASSERT(trajectory.poses.front().size() == model.bodies.size(), "a trajectory that is not of this model");
    Assembly out;
    out.length_unit = model.length_unit;
    out.up = up_of(model.gravity);
    const std::vector<Colour> colours = part_colours(model);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const core::model::Body& body = model.bodies[b];
        out.parts.push_back({body.name, colours[b], body.mesh, body.reference_point, false});
    }
    out.keyframes.push_back({core::stepper::time_at(trajectory, 0), true, trajectory.poses.front()});
    for (int t = 0; t < count_of(trajectory.steps); ++t) add_step(trajectory, t, out);
    for (std::size_t b = 0; b < out.parts.size(); ++b)
        out.parts[b].moves = std::any_of(out.keyframes.begin(), out.keyframes.end(),
                                         [&](const Keyframe& key) { return !same(key.poses[b], out.keyframes.front().poses[b]); });
    return out;
}

core::geometry::Mesh file_mesh(const AssemblyPart& part) {
    core::geometry::Mesh mesh = part.mesh;
    mesh.vertices.colwise() += part.reference_point;
    return mesh;
}

Pose file_pose(const AssemblyPart& part, const Pose& pose) {
    return {pose.rotation, core::kinematics::world_position(pose, -part.reference_point)};
}

Vector3 up_of(const Vector3& gravity) {
    int axis = 2;
    if (!(gravity.norm() > 0)) return Vector3::UnitZ();
    gravity.cwiseAbs().maxCoeff(&axis);
    return (gravity[axis] > 0 ? -1.0 : 1.0) * Vector3::Unit(axis);
}

}  // namespace fettle::design::exports
