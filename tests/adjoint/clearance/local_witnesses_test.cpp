// SPDX-License-Identifier: MIT
// What could become the witness of a clearance over ranges: closed forms of the local minima.
#include "adjoint/clearance/local_witnesses.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "adjoint/clearance/range_adjoint.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/setup/build_model.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::adjoint::clearance::local_witnesses_test {

namespace {

using core::clearance::PairClearance;

constexpr double long_end = 0.08, short_end = 0.07, half_width = 0.005, post_y = 0.1;

// A lever that turns about z, its longer end towards x, and a post beside it that both ends pass.
core::model::Model lever_and_post(double low, double high) {
    core::scene::Body lever, post;
    lever.name = "lever";
    lever.density = 1000;
    lever.density_given = true;
    lever.mesh = tests::support::box_mesh({-short_end, -half_width, -half_width}, {long_end, half_width, half_width});
    post.name = "post";
    post.type = core::scene::BodyType::static_body;
    for (auto& coordinate : post.prescribed) coordinate = core::scene::MotionCurve{};
    post.mesh = tests::support::box_mesh({-0.02, 0, -0.01}, {0.02, 0.02, 0.01});
    post.pose.position = {0, post_y, 0};
    core::scene::Scene scene;
    scene.bodies = {lever, post};
    core::scene::Joint pivot;
    pivot.name = "pivot";
    pivot.kind = core::scene::JointKind::revolute;
    pivot.b = {"lever", Vector3::Zero(), Vector3::UnitZ()};
    pivot.forces.limits = {low, high};
    scene.mechanism.joints = {pivot};
    auto model = core::setup::build_model(scene);
    REQUIRE(model);
    return std::move(model).value();
}

struct Found {
    PairClearance pair;
    std::vector<PairClearance> others;
};

Found found(double low, double high, double room) {
    const core::model::Model model = lever_and_post(low, high);
    const auto ranges = core::clearance::joint_ranges(model);
    REQUIRE(ranges);
    Found out;
    out.pair = settled_witness(model, *ranges, core::clearance::certify(model, *ranges, {{0, 1}}, {}).front());
    out.others = local_witnesses(model, *ranges, out.pair, {room, 8, 11});
    return out;
}

bool has(const std::vector<PairClearance>& pairs, double distance, double angle) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PairClearance& pair) {
        return std::abs(pair.witness.distance - distance) < 1e-9 && std::abs(pair.at.at(0) - angle) < 1e-4;
    });
}

}  // namespace

TEST_CASE("over ranges each local minimum is a witness, where it is least", "[clearance][adjoint]") {
    const double long_reach = std::hypot(long_end, half_width), short_reach = std::hypot(short_end, half_width);
    const double long_lean = std::atan(half_width / long_end), short_lean = std::atan(half_width / short_end);
    const Found at = found(-2.8, 2.8, 0.02);
    CHECK(at.pair.witness.distance == Approx(post_y - long_reach).margin(1e-12));
    CHECK(std::abs(std::abs(at.pair.at[0] - M_PI / 2) - long_lean) < 1e-4);
    CAPTURE(at.others.size());
    // The other corner of the same end, and both of the other end.
    const double other_corner = at.pair.at[0] < M_PI / 2 ? M_PI / 2 + long_lean : M_PI / 2 - long_lean;
    CHECK(has(at.others, post_y - long_reach, other_corner));
    CHECK(has(at.others, post_y - short_reach, -M_PI / 2 + short_lean));
    CHECK(has(at.others, post_y - short_reach, -M_PI / 2 - short_lean));
    for (const PairClearance& other : at.others) {
        CHECK(other.witness.distance >= at.pair.lower);
        CHECK(other.upper - other.witness.distance == Approx(at.pair.upper - at.pair.witness.distance).margin(1e-15));
    }
}

TEST_CASE("over ranges an end of a range is a place as any other, and what is beyond the room is left out", "[clearance][adjoint]") {
    const double high = 0.9;
    const Found at = found(-2.8, high, 0.03);
    CHECK(at.pair.witness.distance == Approx(post_y - std::hypot(short_end, half_width)).margin(1e-12));
    const double x = long_end * std::cos(high) - half_width * std::sin(high), y = long_end * std::sin(high) + half_width * std::cos(high);
    const double distance = std::hypot(x - 0.02, post_y - y);
    REQUIRE(distance > at.pair.witness.distance);
    REQUIRE(distance < at.pair.witness.distance + 0.03);
    CHECK(has(at.others, distance, high));
    CHECK_FALSE(has(found(-2.8, high, 0.5 * (distance - at.pair.witness.distance)).others, distance, high));
}

}  // namespace fettle::adjoint::clearance::local_witnesses_test
