// SPDX-License-Identifier: MIT
// Clearances over the ranges of joints: closed forms of their least distance and of its derivative. By everything that a design moves:
// tests/design/quantities/clearance_test.cpp.
#include "adjoint/clearance/range_adjoint.hpp"

#include <catch2/catch.hpp>

#include "core/setup/build_model.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::adjoint::clearance::range_adjoint_test {

namespace {

using core::clearance::PairClearance;

constexpr double length = 0.08, half_width = 0.005, post_y = 0.1;

// An arm that turns about z from x on, and a post beside it, below which it can stand square, if its limits let it.
core::scene::Scene arm_and_post(double low, double high) {
    core::scene::Body arm, post;
    arm.name = "arm";
    arm.density = 1000;
    arm.density_given = true;
    arm.mesh = tests::support::box_mesh({0, -half_width, -half_width}, {length, half_width, half_width});
    post.name = "post";
    post.type = core::scene::BodyType::static_body;
    for (auto& coordinate : post.prescribed) coordinate = core::scene::MotionCurve{};
    post.mesh = tests::support::box_mesh({-0.02, 0, -0.01}, {0.02, 0.02, 0.01});
    post.pose.position = {0, post_y, 0};
    core::scene::Scene scene;
    scene.bodies = {arm, post};
    core::scene::Joint pivot;
    pivot.name = "pivot";
    pivot.kind = core::scene::JointKind::revolute;
    pivot.b = {"arm", Vector3::Zero(), Vector3::UnitZ()};
    pivot.forces.limits = {low, high};
    scene.mechanism.joints = {pivot};
    return scene;
}

struct Certified {
    core::model::Model model;
    core::clearance::JointRanges ranges;
    PairClearance pair;
};

Certified certified(const core::scene::Scene& scene, double tolerance = 1e-6) {
    auto model = core::setup::build_model(scene);
    for (const auto& error : model.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(model);
    auto ranges = core::clearance::joint_ranges(*model);
    REQUIRE(ranges);
    core::clearance::ClearanceOptions options;
    options.tolerance = tolerance;
    const PairClearance found = core::clearance::certify(*model, *ranges, {{0, 1}}, options).front();
    PairClearance pair = settled_witness(*model, *ranges, found);
    CHECK(pair.upper <= found.upper);
    CHECK(pair.lower <= pair.upper);
    return {std::move(model).value(), std::move(ranges).value(), pair};
}

Certified certified(double low, double high) { return certified(arm_and_post(low, high)); }

core::scene::Scene arm_on_a_ball(std::optional<double> swing) {
    core::scene::Scene scene = arm_and_post(-1, 1);
    core::scene::Joint& pivot = scene.mechanism.joints[0];
    pivot.kind = core::scene::JointKind::ball;
    pivot.a.axis = pivot.b.axis = Vector3::UnitX();
    pivot.forces = {};
    pivot.swing = swing;
    return scene;
}

}  // namespace

TEST_CASE("a clearance over ranges is least inside them where a corner passes, and settles there to rounding") {
    const Certified at = certified(-0.2, 2.8);
    // The corner farthest from the pivot points straight at the post.
    const double reach = std::hypot(length, half_width);
    CHECK(at.pair.upper == Approx(post_y - reach).margin(1e-12));
    ModelGradient bar = zero_model_gradient(at.model, 0);
    REQUIRE(range_clearance_adjoint(at.model, at.ranges, at.pair, 1, bar).empty());
    CHECK(bar.bodies[1].pose_start_bar.col(3).isApprox(Vector3(0, 1, 0), 1e-9));
    const Vector3 to_corner = Vector3(length, half_width, 0) / reach;  // along which the arm is longer where it starts
    CHECK(bar.bodies[0].pose_start_bar.col(3).isApprox(-to_corner, 1e-7));
    CHECK(bar.mechanism.frames[0].point.isApprox(Vector3(0, -1, 0) + to_corner, 1e-7));
    for (const double limit : bar.mechanism.term_reference) CHECK(limit == 0);
    // Longer by dx: d(reach) = length / reach.
    double by_length = 0;
    for (int v = 0; v < 8; ++v)
        if (at.model.bodies[0].mesh.vertices(0, v) > at.model.bodies[0].mesh.vertices.row(0).mean())
            by_length += bar.bodies[0].vertices_bar(0, v);
    CHECK(by_length == Approx(-length / reach).epsilon(1e-9));
}

TEST_CASE("a clearance over ranges that is least at the end of a range moves with that end") {
    const double high = 0.9;
    const Certified at = certified(-0.2, high);
    // At the end of its range the arm's upper corner (length, half_width), turned by `high`, is nearest: the post's corner (0.02, post_y)
    // is beside it, above its face or its edge.
    const auto distance = [&](double angle) {
        const double x = length * std::cos(angle) - half_width * std::sin(angle),
                     y = length * std::sin(angle) + half_width * std::cos(angle);
        return std::hypot(x - 0.02, post_y - y);
    };
    CHECK(at.pair.upper == Approx(distance(high)).margin(1e-12));
    ModelGradient bar = zero_model_gradient(at.model, 0);
    REQUIRE(range_clearance_adjoint(at.model, at.ranges, at.pair, 2, bar).empty());
    double by_limit = 0;
    for (const double limit : bar.mechanism.term_reference) by_limit += limit;
    const double h = 1e-6;
    CHECK(by_limit == Approx(2 * (distance(high + h) - distance(high - h)) / (2 * h)).epsilon(1e-8));
}

TEST_CASE("a clearance over all turns of a ball joint is least where a corner passes; at the end of a swing it has no derivative") {
    const Certified at = certified(arm_on_a_ball(std::nullopt), 2e-3);
    const Vector3 corner(length, half_width, half_width);
    CHECK(at.pair.upper == Approx(post_y - corner.norm()).margin(1e-6));
    ModelGradient bar = zero_model_gradient(at.model, 0);
    REQUIRE(range_clearance_adjoint(at.model, at.ranges, at.pair, 1, bar).empty());
    CHECK(bar.bodies[1].pose_start_bar.col(3).isApprox(Vector3(0, 1, 0), 1e-4));
    double by_length = 0;  // longer by dx: d(reach) = length / reach
    for (int v = 0; v < 8; ++v)
        if (at.model.bodies[0].mesh.vertices(0, v) > at.model.bodies[0].mesh.vertices.row(0).mean())
            by_length += bar.bodies[0].vertices_bar(0, v);
    CHECK(by_length == Approx(-length / corner.norm()).epsilon(1e-3));
    const Certified end = certified(arm_on_a_ball(0.5), 2e-3);
    ModelGradient other = zero_model_gradient(end.model, 0);
    CHECK(range_clearance_adjoint(end.model, end.ranges, end.pair, 1, other).find("end of the swing of `pivot`") != std::string::npos);
}

}  // namespace fettle::adjoint::clearance::range_adjoint_test
