// SPDX-License-Identifier: MIT
/// Small moving pairs whose certified clearance is differentiated: as coordinates, six a pose (dq, phi), then three a vertex.
#pragma once

#include "adjoint/clearance/clearance_adjoint.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"

namespace fettle::tests::clearance_cases {

using namespace fettle::tests::clearance;
using core::clearance::certify;
using core::clearance::PairClearance;
using core::kinematics::Pose;

inline core::model::Body make_body(const Solid& solid) {
    core::model::Body body;
    body.mesh = solid.mesh;
    body.hierarchy = solid.hierarchy;
    return body;
}

// A node between the poses of a step, per body: at fraction sigma of the straight path, off it by an offset that turns with the start pose.
struct Bend {
    double sigma;
    Vector3 offset, twist;
};
using Bends = std::vector<std::vector<Bend>>;  // [node][body], the same in every step

// The trajectory through given poses, one straight segment a step, or through the bends.
inline core::stepper::Trajectory through(const std::vector<std::vector<Pose>>& poses, const Bends& bends = {}) {
    core::stepper::Trajectory trajectory;
    trajectory.timestep = 0.1;
    trajectory.poses = poses;
    for (std::size_t t = 0; t + 1 < poses.size(); ++t) {
        core::stepper::TrajectoryStep step;
        step.nodes.resize(2 + bends.size());
        for (std::size_t i = 0; i < poses[t].size(); ++i) {
            const Pose &start = poses[t][i], &end = poses[t + 1][i];
            const Vector3 theta = core::kinematics::rotation_vector(end.rotation * start.rotation.transpose());
            step.nodes.front().push_back({start.position, Vector3::Zero()});
            for (std::size_t k = 0; k < bends.size(); ++k) {
                const Bend& bend = bends[k][i];
                step.nodes[k + 1].push_back({(1 - bend.sigma) * start.position + bend.sigma * end.position + start.rotation * bend.offset,
                                             bend.sigma * theta + start.rotation * bend.twist});
            }
            step.nodes.back().push_back({end.position, theta});
        }
        trajectory.steps.push_back(step);
    }
    return trajectory;
}

inline adjoint::TrajectoryGradient zero_like(const core::stepper::Trajectory& trajectory) {
    adjoint::TrajectoryGradient bar;
    for (const auto& poses : trajectory.poses) bar.pose_bar.emplace_back(poses.size(), Matrix34::Zero());
    return bar;
}

inline adjoint::ModelGradient zero_like(const core::model::Model& model) {
    adjoint::ModelGradient bar;
    bar.bodies.resize(model.bodies.size());
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
        bar.bodies[i].vertices_bar = Matrix3X::Zero(3, model.bodies[i].mesh.vertices.cols());
    return bar;
}

struct Case {
    core::model::Model model;
    std::vector<std::vector<Pose>> poses;
    bool motion = false;
    bool swapped = false;  // the pair asked for is (1, 0)
    Bends bends{};
    double witness_tolerance = 0;
    core::stepper::Trajectory trajectory() const { return through(poses, bends); }
    PairClearance certify() const { return certify(trajectory()); }
    PairClearance certify(const core::stepper::Trajectory& trajectory) const {
        core::clearance::ClearanceOptions options;
        options.tolerance = 1e-12;
        options.motion = motion;
        options.witness_tolerance = witness_tolerance;
        return core::clearance::certify(
            model, trajectory, {swapped ? core::clearance::PairRequest{1, 0, 0} : core::clearance::PairRequest{0, 1, 0}}, options)[0];
    }
};

// Tangent coordinates: six a pose (dq, phi), then three a vertex.
inline Case moved(const Case& start, const VectorX& d) {
    Case result = start;
    Eigen::Index at = 0;
    for (auto& poses : result.poses)
        for (Pose& pose : poses) {
            pose.position += d.segment<3>(at);
            pose.rotation = core::kinematics::rotation(d.segment<3>(at + 3)) * pose.rotation;
            at += 6;
        }
    for (core::model::Body& body : result.model.bodies) {
        for (Eigen::Index v = 0; v < body.mesh.vertices.cols(); ++v, at += 3) body.mesh.vertices.col(v) += d.segment<3>(at);
        body.hierarchy = std::make_shared<core::geometry::BodyHierarchy>(body.mesh);
    }
    return result;
}

inline Eigen::Index coordinate_count(const Case& c) {
    Eigen::Index n = static_cast<Eigen::Index>(6 * 2 * c.poses.size());
    for (const core::model::Body& body : c.model.bodies) n += 3 * body.mesh.vertices.cols();
    return n;
}

inline VectorX gradient_of(const Case& c, const PairClearance& pair, double scale) {
    const auto trajectory = c.trajectory();
    auto trajectory_bar = zero_like(trajectory);
    auto model_bar = zero_like(c.model);
    REQUIRE(adjoint::clearance::clearance_adjoint(c.model, trajectory, pair, scale, trajectory_bar, model_bar).empty());
    VectorX g = VectorX::Zero(coordinate_count(c));
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < c.poses.size(); ++t)
        for (std::size_t i = 0; i < 2; ++i, at += 6) {
            const Matrix34& bar = trajectory_bar.pose_bar[t][i];
            g.segment<3>(at) = bar.col(3);
            for (int k = 0; k < 3; ++k)  // <bar, [e_k] R>
                g[at + 3 + k] = (bar.leftCols<3>().transpose() * cross_matrix(Vector3::Unit(k)) * c.poses[t][i].rotation).trace();
        }
    for (const auto& body : model_bar.bodies)
        for (Eigen::Index v = 0; v < body.vertices_bar.cols(); ++v, at += 3) g.segment<3>(at) = body.vertices_bar.col(v);
    return g;
}

inline Case random_case(std::mt19937& random, bool motion) {
    std::uniform_real_distribution<double> u(0, 1);
    const Solid a = tetrahedron(random, 1), b = tetrahedron(random, 1);
    Case c;
    c.model.bodies = {make_body(a), make_body(b)};
    c.motion = motion;
    const Vector3 away = random_vector(random, (a.radius() + b.radius()) * (0.6 + 0.5 * u(random)));
    const Vector3 along = away.cross(random_vector(random, 1)).normalized() * (3 * u(random));
    for (int t = 0; t < (motion ? 3 : 1); ++t) {
        const double at = motion ? t - 1 : 0;
        c.poses.push_back({{core::kinematics::rotation(random_vector(random, 0.8)), 0.2 * at * Vector3::Ones()},
                           {core::kinematics::rotation(random_vector(random, 0.8)), away + at * along}});
    }
    return c;
}

}  // namespace fettle::tests::clearance_cases
