// SPDX-License-Identifier: MIT
#include "fettle/adjoint/clearance/clearance_adjoint.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <array>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/geometry/distance.hpp"

namespace fettle::adjoint {
namespace {

using core::clearance::PairClearance;
using core::clearance::Witness;
using core::kinematics::Pose;
using core::stepper::Trajectory;

struct WitnessVertex {
    int body;
    int vertex;
};

// In the order of the distance functions: vertex first, or edge of a first.
std::array<WitnessVertex, 4> witness_vertices(const core::model::Model& model, const PairClearance& pair) {
    const Witness& w = pair.witness;
    const core::geometry::Mesh &a = model.bodies[pair.a].mesh, &b = model.bodies[pair.b].mesh;
    if (w.edge_edge) {
        const auto &ea = a.edges[w.primitive_a], &eb = b.edges[w.primitive_b];
        return {{{pair.a, ea[0]}, {pair.a, ea[1]}, {pair.b, eb[0]}, {pair.b, eb[1]}}};
    }
    if (w.vertex_on_a) {
        const auto& t = b.triangles[w.primitive_b];
        return {{{pair.a, w.primitive_a}, {pair.b, t[0]}, {pair.b, t[1]}, {pair.b, t[2]}}};
    }
    const auto& t = a.triangles[w.primitive_a];
    return {{{pair.b, w.primitive_b}, {pair.a, t[0]}, {pair.a, t[1]}, {pair.a, t[2]}}};
}

Pose witness_pose(const Trajectory& trajectory, const Witness& witness, int body) {
    if (witness.step < 0) return trajectory.poses.front()[body];
    return core::kinematics::pose_at(core::stepper::path_segment(trajectory, witness.step, witness.segment, body), witness.s);
}

struct Wrench {
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  // dual to dq and to phi in dR = [phi] R
};

void add_wrench(const Pose& pose, const Vector3& force, const Vector3& torque, Matrix34& bar) {
    bar.leftCols<3>() += 0.5 * cross_matrix(torque) * pose.rotation;
    bar.col(3) += force;
}

void pull_to_configurations(const Trajectory& trajectory, const Witness& witness, int body, const Wrench& wrench, TrajectoryGradient& bar) {
    if (witness.step < 0) {
        add_wrench(trajectory.poses.front()[body], wrench.force, wrench.torque, bar.pose_bar.front()[body]);
        return;
    }
    const int t = witness.step;
    const double s = (witness.segment + witness.s) / core::stepper::segment_count(trajectory, t);
    const Vector3 theta = trajectory.steps[t].nodes.back()[body].rotation_vector;
    const Vector3 to_theta = s * core::kinematics::left_jacobian(s * theta).transpose() * wrench.torque;
    const Vector3 to_end = core::kinematics::left_jacobian(theta).inverse().transpose() * to_theta;
    FETTLE_ASSERT(to_end.allFinite(), "a whole turn in one step has no derivative by its end pose");
    const Vector3 to_start =
        core::kinematics::rotation(s * theta).transpose() * wrench.torque - core::kinematics::rotation(theta).transpose() * to_end;
    add_wrench(trajectory.poses[t][body], (1 - s) * wrench.force, to_start, bar.pose_bar[t][body]);
    add_wrench(trajectory.poses[t + 1][body], s * wrench.force, to_end, bar.pose_bar[t + 1][body]);
}

}  // namespace

void clearance_adjoint(const core::model::Model& model, const Trajectory& trajectory, const PairClearance& pair, double scale,
                       TrajectoryGradient& trajectory_bar, ModelGradient& model_bar) {
    const auto vertices = witness_vertices(model, pair);
    const Pose pose_a = witness_pose(trajectory, pair.witness, pair.a), pose_b = witness_pose(trajectory, pair.witness, pair.b);
    const Vector3 offset = pose_a.position - pose_b.position;
    std::array<Vector3, 4> arms, x;  // R X; relative to q_b, so that a place far from the origin costs no digits
    for (std::size_t i = 0; i < 4; ++i) {
        const bool on_a = vertices[i].body == pair.a;
        arms[i] = (on_a ? pose_a : pose_b).rotation * model.bodies[vertices[i].body].mesh.vertices.col(vertices[i].vertex);
        x[i] = on_a ? Vector3(arms[i] + offset) : arms[i];
    }
    const core::geometry::ClosestPoints closest = pair.witness.edge_edge ? core::geometry::edge_edge_closest(x[0], x[1], x[2], x[3])
                                                                         : core::geometry::point_triangle_closest(x[0], x[1], x[2], x[3]);
    const double distance = closest.difference.norm();
    if (!(pair.upper > 0 && distance > 0)) return;
    const Vector3 n = closest.difference * (scale / distance);
    Wrench on_a, on_b;
    for (std::size_t i = 0; i < 4; ++i) {
        const bool is_a = vertices[i].body == pair.a;
        const Vector3 force = closest.weight[i] * n;
        (is_a ? on_a : on_b).force += force;
        (is_a ? on_a : on_b).torque += arms[i].cross(force);
        model_bar.bodies[vertices[i].body].vertices_bar.col(vertices[i].vertex) += (is_a ? pose_a : pose_b).rotation.transpose() * force;
    }
    pull_to_configurations(trajectory, pair.witness, pair.a, on_a, trajectory_bar);
    pull_to_configurations(trajectory, pair.witness, pair.b, on_b, trajectory_bar);
}

}  // namespace fettle::adjoint
