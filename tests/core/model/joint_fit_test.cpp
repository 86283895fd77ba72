// SPDX-License-Identifier: MIT
// Which overlaps a joint explains: pins and bores about its axis, balls about its point, and nothing else.
#include "core/model/joint_fit.hpp"

#include <catch2/catch.hpp>

#include "core/setup/build_model.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/core/geometry/sample_meshes.hpp"
#include "tests/support/skip.hpp"

namespace fettle::core::model::joint_fit_test {

using scene::JointKind;
using tests::clearance::prism;
using tests::clearance::ring;

namespace {

struct Placed {
    geometry::Mesh mesh;
    Vector3 position = Vector3::Zero();
    double turn = 0;  // about z
};

// Two bodies, the first static, and a joint between them at `point`, its axis z.
JoinedOverlap overlap(const Placed& a, const Placed& b, JointKind kind, const Vector3& point = Vector3::Zero()) {
    scene::Scene scene;
    for (const Placed* each : {&a, &b}) {
        scene::Body body;
        body.name = each == &a ? "a" : "b";
        body.mesh = each->mesh;
        body.type = each == &a ? scene::BodyType::static_body : scene::BodyType::dynamic_body;
        body.pose = {kinematics::rotation(Vector3(0, 0, each->turn)), each->position};
        scene.bodies.push_back(body);
    }
    scene::Joint joint;
    joint.name = "j";
    joint.kind = kind;
    const auto end = [&](const Placed& of) {
        return scene::Attachment{&of == &a ? "a" : "b", kinematics::rotation(Vector3(0, 0, -of.turn)) * (point - of.position),
                                 Vector3::UnitZ()};
    };
    joint.a = end(a);
    joint.b = end(b);
    scene.mechanism.joints = {joint};
    setup::BuildOptions options;
    options.check_start = false;
    const auto model = setup::build_model(scene, options);
    REQUIRE(model);
    REQUIRE(joints_between(*model, 0, 1) == std::vector<std::string>{"j"});
    const auto found = joined_overlap(*model, 0, 1);
    REQUIRE(found);
    return *found;
}

geometry::Mesh cube(double x, double y, double z) { return tests::box_mesh({-x / 2, -y / 2, -z / 2}, {x / 2, y / 2, z / 2}); }

}  // namespace

TEST_CASE("A pin in its bore is explained by a joint about their axis, one without a bore or far too wide is not", "[model][joints]") {
    if (!parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const Placed hub{ring(32, 3, 8, 6).mesh}, solid{prism(48, 8, 6).mesh};
    for (const JointKind kind : {JointKind::revolute, JointKind::cylindrical, JointKind::prismatic})
        for (const Placed& hole : {hub, solid})
            for (const double radius : {3.0, 3.1, 3.3, 3.7}) {
                const Placed pin{prism(24, radius, 20).mesh, Vector3::Zero(), 0.05};
                const bool has_bore = hole.mesh.vertices.cols() == hub.mesh.vertices.cols();
                CAPTURE(static_cast<int>(kind), radius, has_bore);
                const JoinedOverlap found = overlap(hole, pin, kind);
                CHECK(found.volume > 0);
                CHECK(found.explained == (has_bore && radius < 3.5));
                CHECK(overlap(pin, hole, kind).explained == found.explained);
            }
    CHECK(!overlap(solid, {prism(24, 3, 2).mesh}, JointKind::revolute).explained);  // buried
    const Placed pin{prism(24, 3, 20).mesh};
    for (const JointKind kind : {JointKind::fixed, JointKind::planar, JointKind::ball}) CHECK(!overlap(hub, pin, kind).explained);
    // About another axis.
    CHECK(!overlap(hub, {prism(24, 3, 20).mesh, {0.5, 0, 0}}, JointKind::revolute).explained);
    CHECK(!overlap(hub, pin, JointKind::revolute, {1, 0, 0}).explained);
}

TEST_CASE("What goes through the other beside the axis, is sunk into it, or is not round is a finding", "[model][joints]") {
    if (!parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const Placed wheel{prism(48, 24, 10).mesh};
    const auto leg = overlap({cube(4, 4, 60), {0, 18, 0}}, wheel, JointKind::revolute);
    CHECK(!leg.explained);
    CHECK(leg.volume == Approx(160));
    CHECK(!overlap({cube(4, 4, 60)}, wheel, JointKind::revolute).explained);                         // a square axle
    CHECK(!overlap({prism(40, 20, 5).mesh, {0, 0, 6.5}}, wheel, JointKind::revolute).explained);     // a shoulder, 1 mm deep
    CHECK(!overlap({ring(40, 12, 20, 5).mesh, {0, 0, 6.5}}, wheel, JointKind::revolute).explained);  // the same with a hole
    CHECK(!overlap({cube(20, 20, 20)}, {cube(20, 20, 20), {10, 0, 0}}, JointKind::fixed).explained);
    // A pin that is explained beside a leg that is not.
    const auto both =
        overlap({tests::joined(prism(24, 3, 60).mesh, tests::box_mesh({-2, 16, -30}, {2, 20, 30}))}, wheel, JointKind::revolute);
    CHECK(!both.explained);
    CHECK(both.volume > 160);
}

TEST_CASE("A ball in its socket is explained by a ball joint at its middle", "[model][joints]") {
    if (!parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const Placed ball{tests::ellipsoid_mesh({5, 5, 5}, 16)}, larger{tests::ellipsoid_mesh({5.2, 5.2, 5.2}, 15)};
    const auto hollow = [](double inner) {
        geometry::Mesh cavity = tests::ellipsoid_mesh({inner, inner, inner}, 15);
        for (geometry::Triangle& t : cavity.triangles) std::swap(t[1], t[2]);
        return Placed{
            tests::joined(tests::ellipsoid_mesh({9, 9, 9}, 15), geometry::make_mesh("cavity", cavity.vertices, cavity.triangles))};
    };
    const Placed socket = hollow(4.95);
    CHECK(overlap(socket, ball, JointKind::ball).volume > 0);
    CHECK(overlap(socket, ball, JointKind::ball).explained);
    CHECK(overlap(ball, socket, JointKind::ball).explained);
    CHECK(!overlap(socket, ball, JointKind::ball, {0, 0, 1}).explained);
    CHECK(!overlap(socket, ball, JointKind::fixed).explained);
    CHECK(!overlap(hollow(4), ball, JointKind::ball).explained);  // far too narrow
    CHECK(!overlap(larger, ball, JointKind::ball).explained);     // no socket
    CHECK(!overlap({cube(6, 6, 6)}, ball, JointKind::ball).explained);
    // Sunk into a wall from outside; and in a block that has its middle, and no socket.
    for (const double depth : {0.5, 2.0, 4.0, 4.9, 6.0})
        CHECK(!overlap({cube(20, 60, 60), {depth - 15, 0, 0}}, ball, JointKind::ball).explained);
}

TEST_CASE("Faces that lie on each other, and bodies apart, have nothing to explain", "[model][joints]") {
    if (!parts::can_cut_solids()) FETTLE_SKIP("this build cannot cut solids");
    const Placed a{cube(10, 10, 10)};
    for (const double apart : {10.0, 12.0}) {
        const auto found = overlap(a, {cube(10, 10, 10), {apart, 0, 0}}, JointKind::revolute, {5, 0, 0});
        CHECK(found.volume == 0);
        CHECK(found.explained);
    }
}

}  // namespace fettle::core::model::joint_fit_test
