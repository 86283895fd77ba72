// SPDX-License-Identifier: MIT
#include "adjoint/clearance/clearance_adjoint.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <limits>

#include "adjoint/clearance/tied_features.hpp"
#include "core/base/contract.hpp"
#include "core/geometry/distance.hpp"

namespace fettle::adjoint::clearance {
namespace {

using core::clearance::PairClearance;
using core::clearance::Witness;
using core::kinematics::ChartPoint;
using core::kinematics::Pose;
using core::stepper::Trajectory;
using core::stepper::TrajectoryStep;

struct WitnessVertex {
    int body;
    int vertex;
};

// A triangle's corners, or an edge or a vertex as one without area.
std::array<int, 3> corners(const core::geometry::Mesh& mesh, core::clearance::Primitive kind, int index) {
    switch (kind) {
        case core::clearance::Primitive::triangle:
            return mesh.triangles[index];
        case core::clearance::Primitive::edge:
            return {mesh.edges[index][0], mesh.edges[index][1], mesh.edges[index][1]};
        case core::clearance::Primitive::vertex:
            break;
    }
    return {index, index, index};
}

// In the order of the distance functions: vertex first, or edge of a first.
std::array<WitnessVertex, 4> witness_vertices(const core::model::Model& model, int a, int b, const Witness& w) {
    const core::geometry::Mesh &mesh_a = model.bodies[a].mesh, &mesh_b = model.bodies[b].mesh;
    if (w.edge_edge) {
        const auto &ea = mesh_a.edges[w.primitive_a], &eb = mesh_b.edges[w.primitive_b];
        return {{{a, ea[0]}, {a, ea[1]}, {b, eb[0]}, {b, eb[1]}}};
    }
    const auto t = w.vertex_on_a ? corners(mesh_b, w.kind_b, w.primitive_b) : corners(mesh_a, w.kind_a, w.primitive_a);
    const int single = w.vertex_on_a ? a : b, other = w.vertex_on_a ? b : a;
    return {{{single, w.vertex_on_a ? w.primitive_a : w.primitive_b}, {other, t[0]}, {other, t[1]}, {other, t[2]}}};
}

struct Wrench {
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  // dual to dq and to phi in dR = [phi] R
};

// At the witness's instant: what the distance is made of.
struct WitnessForces {
    std::vector<ClearanceGradient::VertexPart> vertices;
    Wrench on_a, on_b;
};

std::optional<WitnessForces> witness_forces(const core::model::Model& model, const Trajectory& trajectory, int a, int b,
                                            const Witness& witness) {
    const auto vertices = witness_vertices(model, a, b, witness);
    const Pose pose_a = pose_at(trajectory, witness.step, witness.segment, witness.s, a);
    const Pose pose_b = pose_at(trajectory, witness.step, witness.segment, witness.s, b);
    const Vector3 offset = pose_a.position - pose_b.position;
    std::array<Vector3, 4> arms, x;  // R X; relative to q_b, so that a place far from the origin costs no digits
    for (std::size_t i = 0; i < 4; ++i) {
        const bool on_a = vertices[i].body == a;
        arms[i] = (on_a ? pose_a : pose_b).rotation * model.bodies[vertices[i].body].mesh.vertices.col(vertices[i].vertex);
        x[i] = on_a ? Vector3(arms[i] + offset) : arms[i];
    }
    const core::geometry::ClosestPoints closest = witness.edge_edge ? core::geometry::edge_edge_closest(x[0], x[1], x[2], x[3])
                                                                    : core::geometry::point_triangle_closest(x[0], x[1], x[2], x[3]);
    const double distance = closest.difference.norm();
    if (!(distance > 0)) return std::nullopt;
    const Vector3 n = closest.difference / distance;
    WitnessForces out;
    for (std::size_t i = 0; i < 4; ++i) {
        const bool is_a = vertices[i].body == a;
        const Vector3 force = closest.weight[i] * n;
        Wrench& wrench = is_a ? out.on_a : out.on_b;
        wrench.force += force;
        wrench.torque += arms[i].cross(force);
        out.vertices.push_back({vertices[i].body, vertices[i].vertex, (is_a ? pose_a : pose_b).rotation.transpose() * force});
    }
    return out;
}

Vector6 stacked(const Vector3& first, const Vector3& second) {
    Vector6 v;
    v << first, second;
    return v;
}

SegmentGradient on_segment(const Trajectory& trajectory, const Witness& w, int body, const Wrench& wrench) {
    const auto& nodes = trajectory.steps[w.step].nodes;
    const Vector3 &from = nodes[w.segment][body].rotation_vector, &to = nodes[w.segment + 1][body].rotation_vector;
    const Vector3 theta = from + w.s * (to - from);
    const Vector3 theta_bar = core::kinematics::left_jacobian(theta).transpose() * wrench.torque;
    SegmentGradient out;
    out.base_bar = core::kinematics::rotation(theta).transpose() * wrench.torque;
    out.node_bar = {stacked((1 - w.s) * wrench.force, (1 - w.s) * theta_bar), stacked(w.s * wrench.force, w.s * theta_bar)};
    return out;
}

// From two nodes of a step, which move by these shares of its ends', to its start and end poses.
void add_to_ends(const Trajectory& trajectory, const Witness& w, int body, const std::array<NodeShare, 2>& shares,
                 const SegmentGradient& on, ClearanceGradient& out) {
    Vector6 to_start = stacked(Vector3::Zero(), on.base_bar), to_end = Vector6::Zero();  // to_end: of the end's chart coordinates
    for (std::size_t i = 0; i < 2; ++i) {
        const Vector6 of_end = shares[i].cwiseProduct(on.node_bar[i]);
        to_start.head<3>() += (on.node_bar[i] - of_end).head<3>();
        to_end += of_end;
    }
    const Vector3 theta = trajectory.steps[w.step].nodes.back()[body].rotation_vector;
    const Vector3 torque = core::kinematics::left_jacobian(theta).inverse().transpose() * to_end.tail<3>();
    FETTLE_ASSERT(torque.allFinite(), "a whole turn in one step has no derivative by its end pose");
    to_end.tail<3>() = torque;
    to_start.tail<3>() -= core::kinematics::rotation(theta).transpose() * torque;
    out.poses.push_back({w.step, body, to_start});
    out.poses.push_back({w.step + 1, body, to_end});
}

// The shares of the bodies at the segment's two nodes. A node that the witness does not depend on counts as the start.
std::array<std::array<NodeShare, 2>, 2> shares_at(const core::model::Model& model, const Trajectory& trajectory, int a, int b,
                                                  const Witness& w) {
    std::array<std::array<NodeShare, 2>, 2> out;
    for (int i = 0; i < 2; ++i) {
        const auto node = node_shares(model, trajectory, w.step, w.segment + i, a, b);
        for (std::size_t body = 0; body < 2; ++body) out[body][i] = node ? (*node)[body] : NodeShare(NodeShare::Zero());
    }
    return out;
}

}  // namespace

std::optional<SegmentGradient> segment_gradient(const core::model::Model& model, const Trajectory& trajectory, int a, int b,
                                                const Witness& witness, int body) {
    FETTLE_ASSERT(witness.step >= 0 && (body == a || body == b), "a witness during the motion, and one of its bodies");
    const auto forces = witness_forces(model, trajectory, a, b, witness);
    if (!forces) return std::nullopt;
    return on_segment(trajectory, witness, body, body == a ? forces->on_a : forces->on_b);
}

ClearanceGradient clearance_gradient(const core::model::Model& model, const Trajectory& trajectory, int a, int b, const Witness& witness) {
    ClearanceGradient out;
    auto forces = witness_forces(model, trajectory, a, b, witness);
    if (!forces) return out;
    out.refusal = no_derivative_at(model, trajectory, a, b, witness);
    if (!out.refusal.empty()) return out;
    out.vertices = std::move(forces->vertices);
    if (witness.step < 0) {
        out.poses.push_back({0, a, stacked(forces->on_a.force, forces->on_a.torque)});
        out.poses.push_back({0, b, stacked(forces->on_b.force, forces->on_b.torque)});
        return out;
    }
    const auto shares = shares_at(model, trajectory, a, b, witness);
    add_to_ends(trajectory, witness, a, shares[0], on_segment(trajectory, witness, a, forces->on_a), out);
    add_to_ends(trajectory, witness, b, shares[1], on_segment(trajectory, witness, b, forces->on_b), out);
    return out;
}

std::string clearance_adjoint(const core::model::Model& model, const Trajectory& trajectory, const PairClearance& pair, double scale,
                              TrajectoryGradient& trajectory_bar, ModelGradient& model_bar) {
    ClearanceGradient gradient = clearance_gradient(model, trajectory, pair.a, pair.b, pair.witness);
    for (const auto& part : gradient.vertices) model_bar.bodies[part.body].vertices_bar.col(part.vertex) += scale * part.bar;
    for (const auto& part : gradient.poses) {
        Matrix34& bar = trajectory_bar.pose_bar[part.t][part.body];
        bar.leftCols<3>() += 0.5 * scale * cross_matrix(part.bar.tail<3>()) * trajectory.poses[part.t][part.body].rotation;
        bar.col(3) += scale * part.bar.head<3>();
    }
    return std::move(gradient.refusal);
}

double directional(const ClearanceGradient& gradient, const ClearanceDirection& direction) {
    double sum = 0;
    for (const auto& part : gradient.poses) sum += part.bar.dot(direction.pose_dot[part.t][part.body]);
    if (direction.vertices_dot.empty()) return sum;
    for (const auto& part : gradient.vertices) sum += part.bar.dot(direction.vertices_dot[part.body].col(part.vertex));
    return sum;
}

std::optional<double> clearance_derivative(const core::model::Model& model, const Trajectory& trajectory, const PairClearance& pair,
                                           const ClearanceDirection& direction, double tolerance) {
    if (!(pair.upper > 0)) return 0;
    const std::vector<Witness> only{pair.witness};
    const std::vector<Witness>& witnesses = pair.witnesses.empty() ? only : pair.witnesses;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < witnesses.size(); ++i) {
        const Witness& at = witnesses[i];
        const auto same = [&](const Witness& w) { return w.step == at.step && w.segment == at.segment && w.s == at.s; };
        if (std::any_of(witnesses.begin(), witnesses.begin() + static_cast<std::ptrdiff_t>(i), same)) continue;  // seen: one instant
        if (!no_derivative_at(model, trajectory, pair.a, pair.b, at).empty()) return std::nullopt;
        for (const Witness& tied : tied_features(model, trajectory, pair.a, pair.b, at, tolerance))
            least = std::min(least, directional(clearance_gradient(model, trajectory, pair.a, pair.b, tied), direction));
    }
    return least;
}

}  // namespace fettle::adjoint::clearance
