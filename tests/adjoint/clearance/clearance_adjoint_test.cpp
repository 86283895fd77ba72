// SPDX-License-Identifier: MIT
#include "fettle/adjoint/clearance/clearance_adjoint.hpp"

#include <catch2/catch.hpp>

#include "fettle/tests/core/clearance/clearance_oracle.hpp"
#include "fettle/tests/support/derivative_check.hpp"

using namespace fettle;
using namespace fettle::tests::clearance;
using core::clearance::certify_clearance;
using core::clearance::PairClearance;
using core::kinematics::Pose;

namespace {

core::model::Body make_body(const Solid& solid) {
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
core::stepper::Trajectory through(const std::vector<std::vector<Pose>>& poses, const Bends& bends = {}) {
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

adjoint::TrajectoryGradient zero_like(const core::stepper::Trajectory& trajectory) {
    adjoint::TrajectoryGradient bar;
    for (const auto& poses : trajectory.poses) bar.pose_bar.emplace_back(poses.size(), Matrix34::Zero());
    return bar;
}

adjoint::ModelGradient zero_like(const core::model::Model& model) {
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
        return certify_clearance(model, trajectory,
                                 {swapped ? core::clearance::PairRequest{1, 0, 0} : core::clearance::PairRequest{0, 1, 0}}, options)[0];
    }
};

// Tangent coordinates: six a pose (dq, phi), then three a vertex.
Case moved(const Case& start, const VectorX& d) {
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
        body.hierarchy = std::make_shared<core::contact::BodyHierarchy>(body.mesh);
    }
    return result;
}

Eigen::Index coordinate_count(const Case& c) {
    Eigen::Index n = static_cast<Eigen::Index>(6 * 2 * c.poses.size());
    for (const core::model::Body& body : c.model.bodies) n += 3 * body.mesh.vertices.cols();
    return n;
}

VectorX gradient_of(const Case& c, const PairClearance& pair, double scale) {
    const auto trajectory = c.trajectory();
    auto trajectory_bar = zero_like(trajectory);
    auto model_bar = zero_like(c.model);
    adjoint::clearance_adjoint(c.model, trajectory, pair, scale, trajectory_bar, model_bar);
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

Case random_case(std::mt19937& random, bool motion) {
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

}  // namespace

TEST_CASE("Clearance's derivative by poses and vertices agrees with differences of certified bounds", "[clearance][adjoint]") {
    std::mt19937 random(3);
    int checked = 0, inside = 0, edges = 0, first = 0, second = 0;
    for (int i = 0; i < 12; ++i) {
        Case c = random_case(random, i % 4 != 0);
        c.swapped = i % 2 == 1;
        const PairClearance pair = c.certify();
        if (pair.upper < 0.05) continue;
        ++checked;
        inside += pair.witness.s > 0 && pair.witness.s < 1;
        edges += pair.witness.edge_edge;
        first += !pair.witness.edge_edge && pair.witness.vertex_on_a;
        second += !pair.witness.edge_edge && !pair.witness.vertex_on_a;
        const auto upper = [&](const VectorX& d) { return moved(c, d).certify().upper; };
        const VectorX gradient = gradient_of(c, pair, 1);
        tests::support::StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 3;
        const auto check = tests::support::check_gradient(upper, VectorX::Zero(gradient.size()), gradient, sweep);
        CAPTURE(i, pair.upper, pair.witness.step, pair.witness.s, pair.witness.edge_edge, check.row, check.analytic, check.difference,
                check.step);
        CHECK((upper(VectorX::Zero(gradient.size())) == pair.upper));
        CHECK(check.relative_error < 1e-8);
        CHECK((gradient_of(c, pair, -3) + 3 * gradient).norm() < 1e-12);
    }
    CAPTURE(checked, inside, edges, first, second);
    CHECK(checked >= 6);
    CHECK(inside >= 2);
    CHECK(edges >= 1);
    CHECK(first >= 1);
    CHECK(second >= 1);
}

TEST_CASE("Moving everything together changes no clearance", "[clearance][adjoint]") {
    std::mt19937 random(8);
    for (int i = 0; i < 10; ++i) {
        const Case c = random_case(random, true);
        const PairClearance pair = c.certify();
        if (pair.upper < 0.05) continue;
        const VectorX g = gradient_of(c, pair, 1);
        VectorX shift = VectorX::Zero(g.size());
        for (Eigen::Index p = 0; p < 6; ++p) shift.segment<3>(6 * p) << 0.3, -1, 2;
        CHECK(std::abs(g.dot(shift)) < 1e-13);
        // A rotation about the world's origin: dq = phi x q and phi for every pose.
        const Vector3 phi(1, 0.5, -0.7);
        VectorX turn = VectorX::Zero(g.size());
        Eigen::Index at = 0;
        for (const auto& poses : c.poses)
            for (const Pose& pose : poses) {
                turn.segment<3>(at) = phi.cross(pose.position);
                turn.segment<3>(at + 3) = phi;
                at += 6;
            }
        CHECK(std::abs(g.dot(turn)) < 1e-12);
    }
}

// Bends whose fractions are what node_fraction finds: offsets square to the straight path, in every step alike (so: one step).
Case bent_case(std::mt19937& random, int nodes) {
    Case c = random_case(random, true);
    c.poses.pop_back();
    for (auto& body : c.model.bodies) body.radius = body.mesh.vertices.colwise().norm().maxCoeff();
    std::uniform_real_distribution<double> u(0.1, 0.3);
    c.bends.resize(static_cast<std::size_t>(nodes));
    for (std::size_t k = 0; k < c.bends.size(); ++k)
        for (std::size_t i = 0; i < 2; ++i)
            c.bends[k].push_back({0.3 * static_cast<double>(k + 1), random_vector(random, u(random)), random_vector(random, u(random))});
    // Take the part along the path off the offsets, and into the fraction.
    const auto step = c.trajectory().steps[0];
    for (std::size_t k = 0; k < c.bends.size(); ++k)
        for (std::size_t i = 0; i < 2; ++i) {
            const auto& nodes_of = step.nodes;
            const double sigma = adjoint::node_fraction(step, static_cast<int>(k) + 1, static_cast<int>(i), c.model.bodies[i].radius);
            const Matrix3 back = c.poses[0][i].rotation.transpose();
            c.bends[k][i] = {
                sigma,
                back * (nodes_of[k + 1][i].position - (1 - sigma) * nodes_of.front()[i].position - sigma * nodes_of.back()[i].position),
                back * (nodes_of[k + 1][i].rotation_vector - sigma * nodes_of.back()[i].rotation_vector)};
        }
    return c;
}

TEST_CASE("Steps with intermediate nodes: the end poses carry the nodes along", "[clearance][adjoint]") {
    std::mt19937 random(21);
    int checked = 0, between = 0, at_node = 0;
    for (int i = 0; i < 14; ++i) {
        const Case c = bent_case(random, 1 + i % 2);
        const PairClearance pair = c.certify();
        if (pair.upper < 0.05) continue;
        ++checked;
        between += pair.witness.s > 0 && pair.witness.s < 1;
        at_node += (pair.witness.s == 0 && pair.witness.segment > 0) ||
                   (pair.witness.s == 1 && pair.witness.segment < static_cast<int>(c.bends.size()));
        const auto upper = [&](const VectorX& d) { return moved(c, d).certify().upper; };
        const VectorX gradient = gradient_of(c, pair, 1);
        tests::support::StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 3;
        const auto check = tests::support::check_gradient(upper, VectorX::Zero(gradient.size()), gradient, sweep);
        CAPTURE(i, pair.upper, pair.witness.segment, pair.witness.s, check.row, check.analytic, check.difference, check.step);
        CHECK(check.relative_error < 1e-7);
        // Moving everything together changes nothing.
        const Vector3 phi(1, 0.5, -0.7), shift(0.3, -1, 2);
        VectorX turn = VectorX::Zero(gradient.size());
        Eigen::Index at = 0;
        for (const auto& poses : c.poses)
            for (const Pose& pose : poses) {
                turn.segment<3>(at) = phi.cross(pose.position) + shift;
                turn.segment<3>(at + 3) = phi;
                at += 6;
            }
        CHECK(std::abs(gradient.dot(turn)) < 1e-12);
    }
    CAPTURE(checked, between, at_node);
    CHECK(checked >= 6);
    CHECK(between >= 2);
    CHECK(at_node >= 1);
}

TEST_CASE("The stored path's own derivative: nodes and base, whatever moves them", "[clearance][adjoint]") {
    std::mt19937 random(5);
    int checked = 0;
    for (int i = 0; i < 12; ++i) {
        const Case c = bent_case(random, 1 + i % 3);
        const auto stored = c.trajectory();
        const PairClearance pair = c.certify(stored);
        if (pair.upper < 0.05) continue;
        ++checked;
        // Coordinates: base rotations of both bodies, then the six of each node; the first and last nodes are free here too.
        const auto nodes = static_cast<Eigen::Index>(stored.steps[0].nodes.size());
        const auto upper = [&](const VectorX& d) {
            auto path = stored;
            for (std::size_t b = 0; b < 2; ++b)
                path.poses[0][b].rotation =
                    core::kinematics::rotation(d.segment<3>(3 * static_cast<Eigen::Index>(b))) * path.poses[0][b].rotation;
            Eigen::Index at = 6;
            for (auto& node : path.steps[0].nodes)
                for (auto& point : node) {
                    point.position += d.segment<3>(at);
                    point.rotation_vector += d.segment<3>(at + 3);
                    at += 6;
                }
            return c.certify(path).upper;
        };
        VectorX gradient = VectorX::Zero(6 + 12 * nodes);
        for (int b = 0; b < 2; ++b) {
            const auto part = adjoint::segment_gradient(c.model, stored, 0, 1, pair.witness, b);
            REQUIRE(part);
            gradient.segment<3>(3 * b) = part->base_bar;
            for (int k = 0; k < 2; ++k)
                gradient.segment<6>(6 + 12 * (pair.witness.segment + k) + 6 * b) = part->node_bar[static_cast<std::size_t>(k)];
        }
        tests::support::StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 3;
        const auto check = tests::support::check_gradient(upper, VectorX::Zero(gradient.size()), gradient, sweep);
        CAPTURE(i, pair.upper, pair.witness.segment, pair.witness.s, check.row, check.analytic, check.difference, check.step);
        CHECK(check.relative_error < 1e-7);
    }
    CHECK(checked >= 6);
}

TEST_CASE("A node's fraction of the straight path", "[clearance][adjoint]") {
    core::stepper::TrajectoryStep step;
    step.nodes = {{{Vector3(0, 0, 0), Vector3::Zero()}}, {{Vector3(1, 5, 0), Vector3::Zero()}}, {{Vector3(4, 0, 0), Vector3::Zero()}}};
    CHECK(adjoint::node_fraction(step, 1, 0, 1) == 0.25);
    step.nodes[2][0].rotation_vector = Vector3(0, 0, 2);
    step.nodes[1][0].rotation_vector = Vector3(0, 0, 2);
    CHECK(adjoint::node_fraction(step, 1, 0, 0) == 0.25);
    CHECK(adjoint::node_fraction(step, 1, 0, 2) == Approx((4.0 + 16) / 32));
    step.nodes[1][0].position = Vector3(-9, 0, 0);
    CHECK(adjoint::node_fraction(step, 1, 0, 0) == 0);
    step.nodes[2][0] = step.nodes[0][0];
    CHECK(adjoint::node_fraction(step, 1, 0, 1) == 0.5);
}

TEST_CASE("Two boxes as assembled: the gap's derivative is known", "[clearance][adjoint]") {
    Case c;
    c.model.bodies = {make_body(box({1, 1, 1})), make_body(box({0.5, 0.5, 0.5}))};
    c.poses = {{Pose{}, Pose{Matrix3::Identity(), {2, 0.1, 0.2}}}};
    const PairClearance pair = c.certify();
    CHECK(pair.upper == Approx(0.5).margin(1e-12));
    const VectorX g = gradient_of(c, pair, 1);
    CHECK((g.segment<3>(0) - Vector3(-1, 0, 0)).norm() < 1e-14);
    CHECK((g.segment<3>(6) - Vector3(1, 0, 0)).norm() < 1e-14);
    // The vertices of each face that the witness rests on carry a weight of one in all.
    CHECK(std::abs(g.segment(12, 24).sum() + 1) < 1e-14);
    CHECK(std::abs(g.segment(36, 24).sum() - 1) < 1e-14);
}

TEST_CASE("Bodies that touch have no direction and get no derivative", "[clearance][adjoint]") {
    Case c;
    c.model.bodies = {make_body(box({1, 1, 1})), make_body(box({0.5, 0.5, 0.5}))};
    c.poses = {{Pose{}, Pose{Matrix3::Identity(), {1.5, 0.1, 0.2}}}};
    const PairClearance pair = c.certify();
    CHECK(pair.lower == 0);
    const VectorX g = gradient_of(c, pair, 1);
    CHECK(g.allFinite());
}
