// SPDX-License-Identifier: MIT
#include "adjoint/clearance/clearance_adjoint.hpp"

#include <catch2/catch.hpp>

#include "tests/adjoint/clearance/clearance_cases.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::adjoint::clearance::clearance_adjoint_test {

using namespace fettle::tests::clearance_cases;

TEST_CASE("Clearance's derivative by poses and vertices agrees with differences of certified bounds", "[clearance][adjoint]") {
    std::mt19937 random(11);  // its nearest features are of all kinds
    int checked = 0, inside = 0, edges = 0, first = 0, second = 0;
    for (int i = 0; i < 12; ++i) {
        Case c = random_case(random, i % 4 != 0);
        c.swapped = i % 2 == 1;
        const PairClearance pair = c.certify();
        if (pair.upper < 0.05) continue;
        ++checked;
        inside += pair.witness.s > 0 && pair.witness.s < 1;
        edges += pair.witness.edge_edge;
        Case other = c;
        other.swapped = !c.swapped;
        const PairClearance turned = other.certify();
        for (const auto& w : {pair.witness, turned.witness}) {
            first += !w.edge_edge && w.vertex_on_a;
            second += !w.edge_edge && !w.vertex_on_a;
        }
        CHECK((gradient_of(c, pair, 1) - gradient_of(other, turned, 1)).norm() < 1e-6);
        const auto upper = [&](const VectorX& d) { return moved(c, d).certify().upper; };
        const VectorX gradient = gradient_of(c, pair, 1);
        tests::support::StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 5;
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
    CHECK(edges >= 3);
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

// One step through nodes off the straight path.
Case bent_case(std::mt19937& random, int nodes) {
    Case c = random_case(random, true);
    c.poses.pop_back();
    std::uniform_real_distribution<double> u(0.1, 0.3);
    c.bends.resize(nodes);
    for (std::size_t k = 0; k < c.bends.size(); ++k)
        for (std::size_t i = 0; i < 2; ++i)
            c.bends[k].push_back({0.3 * static_cast<double>(k + 1), random_vector(random, u(random)), random_vector(random, u(random))});
    return c;
}

TEST_CASE("Nodes of a path that say nothing of how they move: no derivative beside them, by name", "[clearance][adjoint]") {
    std::mt19937 random(21);
    int beside = 0, at_ends = 0;
    for (int i = 0; i < 24; ++i) {
        Case c = bent_case(random, 1 + i % 2);
        c.model.bodies[0].name = "arm";
        c.model.bodies[1].name = "stop";
        const PairClearance pair = c.certify();
        if (pair.upper < 0.05) continue;
        const auto gradient = adjoint::clearance::clearance_gradient(c.model, c.trajectory(), 0, 1, pair.witness);
        const bool is_end =
            (pair.witness.segment == 0 && pair.witness.s == 0) || (pair.witness.segment == count_of(c.bends) && pair.witness.s == 1);
        at_ends += is_end;
        beside += !is_end;
        CAPTURE(i, pair.witness.segment, pair.witness.s, gradient.refusal);
        CHECK(gradient.refusal.empty() == is_end);
        CHECK(gradient.poses.empty() != is_end);
        if (!is_end) CHECK(gradient.refusal.find("step 1: 'arm' and 'stop'") == 0);
    }
    CHECK(beside >= 4);
    CHECK(at_ends >= 2);
}

TEST_CASE("Nodes on the straight way that both bodies have passed alike change no derivative", "[clearance][adjoint]") {
    std::mt19937 random(22);
    int checked = 0;
    for (int i = 0; i < 14; ++i) {
        Case c = random_case(random, true), cut = c;
        c.poses.pop_back();
        cut.poses.pop_back();
        cut.bends = {{{0.3, Vector3::Zero(), Vector3::Zero()}, {0.3, Vector3::Zero(), Vector3::Zero()}}};
        const PairClearance pair = c.certify(), same = cut.certify();
        if (pair.upper < 0.05 || !(pair.witness.s > 0 && pair.witness.s < 1)) continue;
        ++checked;
        CHECK((gradient_of(c, pair, 1) - gradient_of(cut, same, 1)).norm() < 1e-6);
        Case apart = cut;  // one is ahead of the other
        apart.bends[0][0].sigma = 0.31;
        const PairClearance ahead = apart.certify();
        CHECK(!adjoint::clearance::clearance_gradient(apart.model, apart.trajectory(), 0, 1, ahead.witness).refusal.empty());
    }
    CHECK(checked >= 3);
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
            const auto part = adjoint::clearance::segment_gradient(c.model, stored, 0, 1, pair.witness, b);
            REQUIRE(part);
            gradient.segment<3>(3 * b) = part->base_bar;
            for (int k = 0; k < 2; ++k) gradient.segment<6>(6 + 12 * (pair.witness.segment + k) + 6 * b) = part->node_bar[k];
        }
        tests::support::StepSweep sweep;
        sweep.largest = 1e-4;
        sweep.count = 5;
        const auto check = tests::support::check_gradient(upper, VectorX::Zero(gradient.size()), gradient, sweep);
        CAPTURE(i, pair.upper, pair.witness.segment, pair.witness.s, check.row, check.analytic, check.difference, check.step);
        CHECK(check.relative_error < 1e-7);
    }
    CHECK(checked >= 6);
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

}  // namespace fettle::adjoint::clearance::clearance_adjoint_test
