// SPDX-License-Identifier: MIT
#include "tests/support/intersection_oracle.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <set>

namespace fettle::tests::support::intersection_oracle_test {

namespace {

SpaceTriangle flat(double z) { return {Vector3(0, 0, z), Vector3(1, 0, z), Vector3(0, 1, z)}; }
const SpaceTriangle upright{Vector3(0.2, 0.2, -1), Vector3(0.2, 0.2, 1), Vector3(0.3, 0.2, 1)};

core::geometry::Mesh tetrahedron() {
    core::geometry::Mesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.vertices << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

/// Two tetrahedra; the second starts at x = 2 and moves by `travel` in one step.
struct TwoBodies {
    core::model::Model model;
    core::stepper::Trajectory trajectory;
    explicit TwoBodies(const Vector3& travel) {
        model.bodies.resize(2);
        for (auto& body : model.bodies) body.mesh = tetrahedron();
        model.bodies[0].name = "a", model.bodies[1].name = "b";
        core::kinematics::Pose first, second;
        second.position = Vector3(2, 0, 0);
        trajectory.poses = {{first, second}, {first, second}};
        trajectory.poses[1][1].position += travel;
        core::kinematics::ChartPoint at_first, start, end;
        start.position = second.position;
        end.position = trajectory.poses[1][1].position;
        trajectory.steps.push_back({{{at_first, start}, {at_first, end}}});
    }
};

}  // namespace

TEST_CASE("exact predicates tell apart what a rounding error apart is", "[support]") {
    CHECK(intersecting_pairs({flat(0)}, {upright}).size() == 1);
    CHECK(intersecting_pairs({flat(1.5)}, {upright}).empty());
    CHECK(intersecting_pairs({flat(1)}, {upright}).size() == 1);                     // touches with its edge
    CHECK(intersecting_pairs({flat(std::nextafter(1.0, 2.0))}, {upright}).empty());  // one ulp higher
    CHECK(intersecting_pairs({flat(0)}, {flat(0)}).size() == 1);                     // coplanar
    CHECK(intersecting_pairs({flat(0)}, {flat(1e-300)}).empty());
}

TEST_CASE("pairs carry the indices of both lists", "[support]") {
    const auto pairs = intersecting_pairs({flat(5), flat(0), flat(0.5)}, {flat(9), upright});
    CHECK(pairs == std::vector<std::pair<int, int>>{{1, 1}, {2, 1}});
    CHECK(intersecting_pairs({}, {upright}).empty());
}

TEST_CASE("bodies that pass through each other between two clear nodes are found", "[support]") {
    const TwoBodies through(Vector3(-4, 0, 0));
    const IntersectionReport none_between = find_intersections(through.model, through.trajectory, 0);
    CHECK(none_between.intersections.empty());
    CHECK(none_between.instants == 3);
    const IntersectionReport report = find_intersections(through.model, through.trajectory, 8);
    CHECK(report.instants == 11);
    REQUIRE_FALSE(report.intersections.empty());
    CHECK(report.intersections.front().body_a == 0);
    CHECK(report.intersections.front().body_b == 1);
    CHECK(report.intersections.front().s == Approx(1 / 3.0));
    CHECK(to_string(report.intersections.front(), through.model).find("a triangle") != std::string::npos);
}

namespace {

/// An edge along z, at x = 2, that flies through an edge along y.
TwoBodies crossing_edges(double gap) {
    TwoBodies bodies(Vector3(-4, 0, 0));
    for (auto& body : bodies.model.bodies) body.mesh.triangles.clear();
    for (auto& body : bodies.model.bodies) body.mesh.vertices.resize(3, 2), body.mesh.edges = {{0, 1}};
    bodies.model.bodies[0].mesh.vertices << 0, 0, -1, 1, 0, 0;
    bodies.model.bodies[1].mesh.vertices << 0, 0, 0, 0, gap, 2;
    return bodies;
}

}  // namespace

TEST_CASE("a loose edge that passes through a loose edge between two instants is found", "[support]") {
    const TwoBodies through = crossing_edges(-1), past = crossing_edges(1e-9);
    for (const int instants : {0, 1, 7, 8}) {
        INFO(instants);
        const IntersectionReport report = find_intersections(through.model, through.trajectory, instants);
        REQUIRE(report.intersections.size() >= 1);
        CHECK(report.intersections.front().s == Approx(0.5).margin(1e-3));
        CHECK(report.intersections.front().element_a.kind == ElementKind::edge);
        CHECK(find_intersections(past.model, past.trajectory, instants).intersections.empty());
    }
}

TEST_CASE("a loose edge that turns past another on a curve is judged by the curve", "[support]") {
    // The arm's tip moves on an arc of radius 1 over the other edge, which stands at x = 1 + gap: chords stay inside
    // the arc, so that those between the instants touch neither.
    for (const double gap : {1e-3, -1e-3}) {
        INFO(gap);
        TwoBodies bodies = crossing_edges(-1);
        bodies.model.bodies[0].mesh.vertices << 1 + gap, 1 + gap, 0, 0, -1, 1;
        bodies.model.bodies[1].mesh.vertices << 0, 1, 0, 0, 0, 0;
        auto& nodes = bodies.trajectory.steps[0].nodes;
        for (auto* node : {&nodes[0], &nodes[1]}) (*node)[1].position.setZero();
        nodes[0][1].rotation_vector = Vector3(0, 0, -1);
        nodes[1][1].rotation_vector = Vector3(0, 0, 1.1);
        bodies.trajectory.poses[0][1] = {core::kinematics::rotation(Vector3(0, 0, 0)), Vector3::Zero()};
        bodies.trajectory.poses[1][1] = bodies.trajectory.poses[0][1];
        IntersectionReport report;
        IntersectionOracle(bodies.model).look_at_step(bodies.trajectory, 0, 3, 10, report);
        CHECK(report.intersections.empty() == (gap > 0));
    }
}

TEST_CASE("a loose point that passes through a triangle is found, one beside it is not", "[support]") {
    for (const double y : {0.2, 2.0}) {
        TwoBodies bodies(Vector3(-4, 0, 0));
        auto& mesh = bodies.model.bodies[1].mesh;
        mesh.triangles.clear();
        mesh.vertices.resize(3, 1);
        mesh.vertices << 0, y, 0.1;
        mesh.codimensional_points = {0};
        const IntersectionReport report = find_intersections(bodies.model, bodies.trajectory, 2);
        CHECK(report.intersections.empty() == (y > 1));
    }
}

TEST_CASE("a loose edge in a triangle is found at an instant", "[support]") {
    TwoBodies bodies(Vector3(0, 0, 0));
    auto& mesh = bodies.model.bodies[1].mesh;
    mesh.triangles.clear();
    mesh.vertices.resize(3, 2);
    mesh.vertices << -1, -3, 0.1, 0.2, 0.1, 0.2;
    mesh.edges = {{0, 1}};
    CHECK_FALSE(find_intersections(bodies.model, bodies.trajectory, 0).intersections.empty());
    mesh.vertices.row(2).setConstant(-0.1);
    CHECK(find_intersections(bodies.model, bodies.trajectory, 0).intersections.empty());
}

TEST_CASE("culling passes over no pair of intersecting triangles", "[support]") {
    // Two tangles of random triangles, in random poses: all pairs, against those that the trees let through.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto vector = [&] { return Vector3(in(random), in(random), in(random)); };
    const auto tangle = [&] {
        core::geometry::Mesh mesh;
        mesh.vertices.resize(3, 60);
        for (int i = 0; i < 60; i += 3) {
            const Vector3 center = 3 * vector();
            for (int k = 0; k < 3; ++k) mesh.vertices.col(i + k) = center + vector();
            mesh.triangles.push_back({i, i + 1, i + 2});
        }
        return mesh;
    };
    int found = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const core::geometry::Mesh a = tangle(), b = tangle();
        const core::kinematics::Pose pose_a{core::kinematics::rotation(2 * vector()), vector()};
        const core::kinematics::Pose pose_b{core::kinematics::rotation(2 * vector()), vector()};
        const auto in_a = triangles_in_space(a, pose_a), in_b = triangles_in_space(b, pose_b);
        const ElementTree tree_a(a), tree_b(b);
        std::set<std::pair<int, int>> near;
        for (const auto& [i, j] : near_elements({tree_a, pose_a, {1e-12, 1e-12}}, {tree_b, pose_b, {1e-12, 1e-12}}))
            near.insert({tree_a.elements()[i].index, tree_b.elements()[j].index});
        for (int i = 0; i < 20; ++i)
            for (int j = 0; j < 20; ++j) {
                if (intersecting_pairs({in_a[i]}, {in_b[j]}).empty()) continue;
                ++found;
                REQUIRE(near.count({i, j}) == 1);
            }
    }
    CHECK(found > 200);
}

TEST_CASE("bodies that pass beside each other are clear, and one group never collides", "[support]") {
    const TwoBodies beside(Vector3(-4, 0, 0) + Vector3(0, 0, 1e-9));
    CHECK(find_intersections(TwoBodies(Vector3(0, 4, 0)).model, TwoBodies(Vector3(0, 4, 0)).trajectory, 8).intersections.empty());
    TwoBodies grouped(Vector3(-4, 0, 0));
    for (auto& body : grouped.model.bodies) body.group = 3;
    CHECK(find_intersections(grouped.model, grouped.trajectory, 8).intersections.empty());
    CHECK_FALSE(find_intersections(beside.model, beside.trajectory, 8).intersections.empty());
}

TEST_CASE("a start configuration without steps is looked at once", "[support]") {
    TwoBodies bodies(Vector3(0, 0, 0));
    bodies.trajectory.steps.clear();
    bodies.trajectory.poses.resize(1);
    CHECK(find_intersections(bodies.model, bodies.trajectory, 8).instants == 1);
    bodies.trajectory.poses[0][1].position = Vector3(0.5, 0.1, 0.1);
    CHECK_FALSE(find_intersections(bodies.model, bodies.trajectory, 8).intersections.empty());
}

}  // namespace fettle::tests::support::intersection_oracle_test
