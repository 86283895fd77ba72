// SPDX-License-Identifier: MIT
#include "core/paper_scenes/fixture_state.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/linear/factorisations.hpp"
#include "core/scene/mass_kind.hpp"

namespace fettle::core::paper_scenes {
namespace {

using base::ErrorCode;

constexpr double equal_moments = 1e-9;  ///< relative

/// Inertia tensor with unit density about the centre of mass, world axes at the start.
Matrix3 placed_inertia(const scene::Body& body) {
    const Matrix4 moments = scene::unit_moments(body.mesh, body.mass_kind);
    const Vector3 first = moments.col(3).head<3>();
    const Matrix3 central = moments.topLeftCorner<3, 3>() - first * first.transpose() / moments(3, 3);
    const Matrix3 placed = body.pose.rotation * central * body.pose.rotation.transpose();
    return placed.trace() * Matrix3::Identity() - placed;
}

void make_equal_what_nearly_is(Matrix3& inertia) {
    const double tolerance = equal_moments * inertia.cwiseAbs().maxCoeff();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (i != j && std::abs(inertia(i, j)) <= tolerance) inertia(i, j) = 0;
            if (i < j && std::abs(inertia(i, i) - inertia(j, j)) <= tolerance) inertia(j, j) = inertia(i, i);
        }
    }
}

struct SavedPose {
    Vector3 position = Vector3::Zero();
    Matrix3 rotation = Matrix3::Identity();
};

SavedPose saved_pose(const files::JsonNode& node) {
    return {fixture_vector(node["position"].unless_null()).value_or(Vector3::Zero()),
            kinematics::rotation(fixture_vector(node["rotation"].unless_null()).value_or(Vector3::Zero()))};
}

/// World axes, radians per second: from dQ/dt = [omega] Q if it is there, else `angular_velocity`, which is about the principal axes.
Vector3 saved_angular_velocity(const files::JsonNode& node, const Matrix3& rotation) {
    const auto rows = node["Qdot"].unless_null().elements();
    if (rows.size() != 3) return rotation * fixture_vector(node["angular_velocity"].unless_null()).value_or(Vector3::Zero());
    Matrix3 derivative;
    for (int i = 0; i < 3; ++i) derivative.row(i) = fixture_vector(rows[i]).value_or(Vector3::Zero());
    const Matrix3 spin = derivative * rotation.transpose();
    return 0.5 * Vector3(spin(2, 1) - spin(1, 2), spin(0, 2) - spin(2, 0), spin(1, 0) - spin(0, 1));
}

void shift_script(scene::Body& body, double passed) {
    const scene::PoseScript script = body.script;
    body.script = {};
    for (std::size_t k = 0; k < script.times.size(); ++k) {
        // A pose is used up at a whole number of steps: rounding must not leave one an instant away.
        if (script.times[k] <= passed * (1 + 1e-12)) continue;
        body.script.times.push_back(script.times[k] - passed);
        body.script.poses.push_back(script.poses[k]);
    }
    for (auto& curve : body.prescribed) {
        if (curve && curve->stop_time) curve->stop_time = std::max(0.0, *curve->stop_time - passed);
    }
}

void continue_body(const files::JsonNode& first, const files::JsonNode& last, scene::Body& body) {
    const SavedPose start = saved_pose(first), end = saved_pose(last);
    const bool moved = start.position != end.position || start.rotation != end.rotation;
    if (moved) {  // a body at rest stays where its file puts it, to the last bit
        const Matrix3 turn = end.rotation * start.rotation.transpose();
        body.pose.position = turn * (body.pose.position - start.position) + end.position;
        body.pose.rotation = kinematics::orthonormalised(turn * body.pose.rotation);
    }
    if (body.type != scene::BodyType::dynamic_body) return;
    body.linear_velocity = fixture_vector(last["linear_velocity"].unless_null()).value_or(Vector3::Zero());
    body.angular_velocity = saved_angular_velocity(last, end.rotation);
    // The velocity is that of that program's centre of mass, which for an open mesh is another than ours.
    if (const auto centre = scene::centre_of_mass(body.mesh, body.mass_kind)) {
        body.linear_velocity += body.angular_velocity.cross(kinematics::world_position(body.pose, *centre) - end.position);
    }
}

}  // namespace

Matrix3 fixture_principal_axes(const scene::Body& body, int fixed_rotations) {
    if (fixed_rotations == 2) return Matrix3::Identity();
    Matrix3 inertia = placed_inertia(body);
    if (!inertia.allFinite()) return Matrix3::Identity();
    make_equal_what_nearly_is(inertia);
    Matrix3 axes = linear::symmetric_eigen<3>(inertia).vectors;
    if (axes.determinant() < 0) axes.col(0) *= -1;
    return axes;
}

scene::PoseScript read_kinematic_poses(const files::JsonNode& node, const scene::Body& body, int fixed_rotations, double timestep,
                                       std::optional<double> stop_time) {
    scene::PoseScript script;
    const auto entries = node.elements();
    if (entries.empty() || stop_time == 0.0) return script;
    const Vector3 centre = scene::centre_of_mass(body.mesh, body.mass_kind).value_or(Vector3::Zero());
    const Matrix3 unturned = fixture_principal_axes(body, fixed_rotations).transpose() * body.pose.rotation;
    for (const files::JsonNode& entry : entries) {
        entry.warn_of_other_keys({"position", "rotation"});
        if (!entry.is_object())
            entry.fail(ErrorCode::wrong_type, "an object with `position` and `rotation` is expected, found " + entry.shown());
        if (!entry.is_object()) continue;
        const SavedPose pose = saved_pose(entry);
        const Matrix3 rotation = kinematics::orthonormalised(pose.rotation * unturned);
        script.times.push_back(static_cast<double>(script.times.size() + 1) * timestep);
        script.poses.push_back({rotation, pose.position - rotation * centre});
    }
    if (!stop_time || script.empty() || *stop_time >= script.times.back()) return script;
    const kinematics::Pose last = scene::scripted_pose(script, body.pose, *stop_time);
    const auto kept =
        static_cast<std::size_t>(std::lower_bound(script.times.begin(), script.times.end(), *stop_time) - script.times.begin());
    script.times.resize(kept);
    script.poses.resize(kept);
    script.times.push_back(*stop_time);
    script.poses.push_back(last);
    return script;
}

void continue_from_last_state(const files::JsonNode& animation, scene::Scene& scene) {
    const files::JsonNode sequence = animation["state_sequence"].unless_null();
    const auto states = sequence.elements();
    if (states.size() < 2) return;
    const auto first = states.front()["rigid_bodies"].elements(), last = states.back()["rigid_bodies"].elements();
    if (first.size() != scene.bodies.size() || last.size() != scene.bodies.size()) {
        sequence.fail(ErrorCode::inconsistent, "the saved states are of " + std::to_string(first.size()) + " and " +
                                                   std::to_string(last.size()) + " bodies, but `args` has " +
                                                   std::to_string(scene.bodies.size()));
        return;
    }
    const double passed = static_cast<double>(states.size() - 1) * scene.timestep;
    for (std::size_t i = 0; i < first.size(); ++i) {
        continue_body(first[i], last[i], scene.bodies[i]);
        shift_script(scene.bodies[i], passed);
    }
    if (!scene.end_time) return;
    const double left = *scene.end_time - passed;
    scene.end_time = left > 1e-9 * scene.timestep ? left : 0;
    if (scene.end_time == 0.0) sequence.warn("the saved simulation has reached its end: say how much further to go");
}

}  // namespace fettle::core::paper_scenes
