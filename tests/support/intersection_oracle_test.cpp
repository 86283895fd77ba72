// SPDX-License-Identifier: MIT
#include "fettle/tests/support/intersection_oracle.hpp"

#include <catch2/catch.hpp>

using namespace fettle;
using namespace fettle::tests::support;

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
    CHECK(intersecting_pairs({flat(1)}, {upright}).size() == 1);                          // touches with its edge
    CHECK(intersecting_pairs({flat(std::nextafter(1.0, 2.0))}, {upright}).empty());      // one ulp higher
    CHECK(intersecting_pairs({flat(0)}, {flat(0)}).size() == 1);                          // coplanar
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
