// SPDX-License-Identifier: MIT
// Ball and planar joints over ranges: their coordinates reach what the joint allows and nothing else; clearances against samples in
// extended precision.
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/free_ranges.hpp"
#include "core/clearance/range_clearance.hpp"
#include "tests/core/clearance/clearance_oracle.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::clearance::ball_ranges_test {

using namespace fettle::tests::mechanisms;
using fettle::tests::clearance::random_vector;
using fettle::tests::clearance::Real;
using scene::JointKind;

namespace {

const Vector3 zero = Vector3::Zero(), x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ();

double uniform(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

Matrix3 random_rotation(std::mt19937& random) { return kinematics::rotation(random_vector(random, uniform(random, 0, M_PI))); }

// Two bars that a joint holds together at random places of theirs; `fixed` is the one that stays.
scene::Scene pair_of_bars(std::mt19937& random, JointKind kind, const std::string& fixed) {
    scene::Body one = bar("one", 0.1), other = bar("other", 0.08);
    one.pose = {random_rotation(random), random_vector(random, 0.05)};
    (fixed == "one" ? one : other).type = scene::BodyType::static_body;
    const Vector3 point_a = random_vector(random, 0.05), point_b = random_vector(random, 0.05), axis = random_vector(random, 1);
    other.pose.rotation = random_rotation(random);
    other.pose.position = one.pose.rotation * point_a + one.pose.position - other.pose.rotation * point_b;
    scene::Scene scene = scene_of({one, other}, 0.01);
    scene.mechanism.joints = {tests::mechanisms::joint("hip", kind, {"one", point_a, one.pose.rotation.transpose() * axis},
                                                       {"other", point_b, other.pose.rotation.transpose() * axis})};
    return scene;
}

struct Placed {
    kinematics::Pose one, other;
};

Placed placed_at(const model::Model& model, const JointRanges& ranges, const std::vector<double>& u) {
    PairClearance pair;
    pair.a = 0;
    pair.b = 1;
    for (int k = 0; k < count_of(u); ++k) pair.coordinates.push_back(k);
    pair.at = u;
    return {pose_at_witness(model, ranges, pair, 0), pose_at_witness(model, ranges, pair, 1)};
}

std::vector<double> random_coordinates(const JointRanges& ranges, std::mt19937& random) {
    std::vector<double> u;
    for (const auto& c : ranges.linkage.coordinates) u.push_back(uniform(random, c.low, c.high));
    return u;
}

// Coordinates of a ball joint that turn b so against a, by the angles z, y, z of textbooks.
std::vector<double> angles_of(const Matrix3& of_b_in_a) {
    const double swing = std::acos(std::clamp(of_b_in_a(2, 2), -1.0, 1.0));
    return {std::atan2(of_b_in_a(1, 2), of_b_in_a(0, 2)), swing, std::atan2(of_b_in_a(2, 1), -of_b_in_a(2, 0))};
}

Matrix3 axes_of(const model::Model& model, int frame, const Placed& at) {
    return (frame == 0 ? at.one : at.other).rotation * model.mechanism.set.frames[model.mechanism.joints[0].frame_a + frame].axes;
}

}  // namespace

TEST_CASE("ball ranges: all that a swing allows is reached, and nothing else", "[ranges]") {
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
        const std::string fixed = i % 2 == 0 ? "one" : "other";
        scene::Scene scene = pair_of_bars(random, JointKind::ball, fixed);
        if (i % 4 < 2) scene.mechanism.joints[0].swing = uniform(random, 0.2, 2.8);
        const model::Model model = built(scene);
        const auto ranges = joint_ranges(model);
        REQUIRE(ranges);
        REQUIRE(ranges->linkage.coordinates.size() == 3);
        const auto& swing = ranges->linkage.coordinates[1];
        CHECK(swing.joints.front().joint == "hip");
        CHECK(swing.low == 0);
        CHECK(swing.high == Approx(scene.mechanism.joints[0].swing.value_or(M_PI)).epsilon(1e-14));
        CHECK(ranges->has_limits[1] == scene.mechanism.joints[0].swing.has_value());
        CHECK(ranges->direction_of == std::vector<int>{-1, 0, -1});
        CHECK(is_direction(*ranges, 0));
        for (int k = 0; k < 20; ++k) {
            const std::vector<double> u = random_coordinates(*ranges, random);
            const Placed at = placed_at(model, *ranges, u);
            const auto frames = placed(model.mechanism.set.frames, {at.one, at.other});
            CHECK((frames[0].point - frames[1].point).norm() < 1e-14);
            const Matrix3 a = axes_of(model, 0, at), b = axes_of(model, 1, at);
            CHECK(std::atan2(a.col(2).cross(b.col(2)).norm(), a.col(2).dot(b.col(2))) == Approx(u[1]).margin(1e-9));
            // And backwards: any rotation has coordinates that lead there.
            const Matrix3 wanted = random_rotation(random);
            std::vector<double> to = angles_of(wanted);
            const Placed start = placed_at(model, *ranges, {0, 0, 0});
            const std::vector<double> from = angles_of(axes_of(model, 0, start).transpose() * axes_of(model, 1, start));
            REQUIRE(from[1] < 1e-7);  // axes are one at the start: b is turned by the sum of the two others
            const Matrix3 turned = axes_of(model, 0, start).transpose() * axes_of(model, 1, start);
            to[2] -= std::atan2(turned(1, 0), turned(0, 0));
            const Placed there = placed_at(model, *ranges, to);
            CHECK((axes_of(model, 0, there).transpose() * axes_of(model, 1, there) - wanted).norm() < 1e-7);
        }
    }
}

TEST_CASE("ball ranges: a start that has swung already", "[ranges]") {
    std::mt19937 random(4);
    for (int i = 0; i < 20; ++i) {
        scene::Scene scene = pair_of_bars(random, JointKind::ball, i % 2 == 0 ? "one" : "other");
        scene.mechanism.joints[0].b.axis += random_vector(random, 0.3);
        scene.mechanism.joints[0].swing = 1;
        const model::Model model = built(scene);
        const auto ranges = joint_ranges(model);
        REQUIRE(ranges);
        for (int k = 0; k < 20; ++k) {
            const std::vector<double> u = random_coordinates(*ranges, random);
            const Placed at = placed_at(model, *ranges, u);
            const Matrix3 a = axes_of(model, 0, at), b = axes_of(model, 1, at);
            CHECK(std::atan2(a.col(2).cross(b.col(2)).norm(), a.col(2).dot(b.col(2))) == Approx(u[1]).margin(1e-9));
        }
    }
    scene::Scene beyond = pair_of_bars(random, JointKind::ball, "one");
    beyond.mechanism.joints[0].b.axis = beyond.mechanism.joints[0].b.axis.unitOrthogonal();
    beyond.mechanism.joints[0].swing = 1;
    const auto model = setup::build_model(beyond);
    REQUIRE(!model);
    CHECK(tests::support::contains(model.errors().front().message, "beyond its `swing`"));
}

TEST_CASE("planar ranges: slides have no limits, which is told; as far as is asked for they are looked at", "[ranges]") {
    std::mt19937 random(5);
    for (int i = 0; i < 10; ++i) {
        const model::Model model = built(pair_of_bars(random, JointKind::planar, i % 2 == 0 ? "one" : "other"));
        const auto refused = joint_ranges(model);
        REQUIRE(!refused);
        CHECK(tests::support::contains(refused.errors().front().message, "has no limits on its two slides"));
        const auto ranges = joint_ranges(model, 0.05);
        REQUIRE(ranges);
        REQUIRE(ranges->linkage.coordinates.size() == 3);
        for (int k = 0; k < 20; ++k) {
            const std::vector<double> u = random_coordinates(*ranges, random);
            const Placed at = placed_at(model, *ranges, u);
            const auto frames = placed(model.mechanism.set.frames, {at.one, at.other});
            const VectorX values = constraint::row_values(model.mechanism.set, model.mechanism.rows, frames,
                                                          std::vector<double>(model.mechanism.set.measures.size(), 0.0));
            for (std::size_t row = 0; row < model.mechanism.rows.size(); ++row)
                CHECK(std::abs(values[row] - model.mechanism.rows[row].constant) < 1e-12);
            CHECK(frames[0].axes.col(0).dot(frames[1].point - frames[0].point) == Approx(u[0]).margin(1e-12));
            CHECK(frames[0].axes.col(1).dot(frames[1].point - frames[0].point) == Approx(u[1]).margin(1e-12));
        }
    }
}

namespace {

// An arm on a ball joint whose axis is the arm's, and a plate beside it.
scene::Scene arm_and_plate(double swing, double away) {
    scene::Body arm = bar("arm", 0.06, zero, zero, 0.004), plate = bar("plate", 0.01, Vector3(0.01, away + 0.01, 0), zero, 0.01);
    plate.type = scene::BodyType::static_body;
    scene::Scene scene = scene_of({arm, plate}, 0.01);
    scene.mechanism.joints = {joint("shoulder", JointKind::ball, {"", zero, x_axis}, {"arm", zero, x_axis})};
    scene.mechanism.joints[0].swing = swing;
    return scene;
}

}  // namespace

TEST_CASE("ball ranges: no sample is below the bound, the bound is attained, its certificate is accepted", "[ranges]") {
    std::mt19937 random(6);
    for (const double away : {0.03, 0.045}) {
        const model::Model model = built(arm_and_plate(0.35, away));
        const auto ranges = joint_ranges(model);
        REQUIRE(ranges);
        ClearanceOptions options;
        options.tolerance = 1e-3;
        const ProvenClearances proven = certify_with_proof(model, *ranges, {{0, 1}}, options);
        const PairClearance& found = proven.pairs.front();
        CAPTURE(found.lower, found.upper, found.bounds);
        CHECK(found.lower > 0);
        CHECK(found.upper - found.lower <= 1e-3);
        const auto distance_at = [&](const std::vector<double>& u) {
            const Placed at = placed_at(model, *ranges, u);
            const auto vertices = [&](int body, const kinematics::Pose& pose) {
                return tests::clearance::RealVertices(
                    (pose.rotation.cast<Real>() * model.bodies[body].mesh.vertices.cast<Real>()).colwise() + pose.position.cast<Real>());
            };
            return static_cast<double>(
                tests::clearance::oracle_distance(model.bodies[0].mesh, vertices(0, at.one), model.bodies[1].mesh, vertices(1, at.other)));
        };
        CHECK(distance_at(found.at) == Approx(found.upper).margin(1e-9));
        for (int i = 0; i < 400; ++i) {
            std::vector<double> u = random_coordinates(*ranges, random);
            const double share = i % 2 == 0 ? 1 : std::pow(10, -uniform(random, 0, 4));
            for (std::size_t k = 0; k < 3; ++k) u[k] = found.at[k] + share * (u[k] - found.at[k]);
            CHECK(distance_at(u) >= found.lower);
        }
        const auto report = check_certificate(proven.certificate, model, as_assembled(model));
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
    }
}

TEST_CASE("ball ranges: two balls in a row, six coordinates", "[ranges]") {
    // Two links from the origin along x, whose axes may swing by 0.3 rad each, and a plate that they cannot reach.
    scene::Body upper = bar("upper", 0.05, zero, zero, 0.004), fore = bar("fore", 0.05, Vector3(0.05, 0, 0), zero, 0.004),
                plate = bar("plate", 0.2, Vector3(-0.05, 0.11, 0), zero, 0.02);
    plate.type = scene::BodyType::static_body;
    scene::Scene scene = scene_of({upper, fore, plate}, 0.01);
    scene.mechanism.joints = {joint("shoulder", JointKind::ball, {"", zero, x_axis}, {"upper", zero, x_axis}),
                              joint("elbow", JointKind::ball, {"upper", Vector3(0.05, 0, 0), x_axis}, {"fore", zero, x_axis})};
    for (auto& each : scene.mechanism.joints) each.swing = 0.3;
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model);
    REQUIRE(ranges);
    const std::vector<PairRequest> pairs{{1, 2, 5e-3}};
    const ProvenClearances proven = certify_with_proof(model, *ranges, pairs, usual_options(pairs, 0.03));
    const PairClearance& found = proven.pairs.front();
    CAPTURE(found.lower, found.upper, found.bounds);
    CHECK(found.coordinates.size() == 6);
    CHECK(found.status == PairStatus::clear);
    CHECK(check_certificate(proven.certificate, model, as_assembled(model)).accepted());
}

TEST_CASE("free ranges: a swing is free to all sides as far as its nearest obstacle", "[ranges]") {
    // The plate's near face is at y = away; the arm's far edge meets its corner or face somewhere on the way.
    const model::Model model = built(arm_and_plate(0.35, 0.03));
    const auto ranges = joint_ranges(model);
    REQUIRE(ranges);
    const auto swing = coordinate_of(*ranges, "shoulder");
    REQUIRE(swing);
    CHECK(*swing == 1);
    FreeRangeOptions options;
    options.angle = 1e-3;
    const FreeRange found = free_ranges(model, *ranges, {*swing}, {{0, 1}}, 0.1, options).front();
    CHECK(!found.turns_freely);
    CHECK(found.below.free == 0);
    CHECK(found.above.kind == RangeEnd::Kind::blocked);
    CHECK(found.above.at - found.above.free <= 1e-3);
    // Every direction is free below it; one is not above.
    const JointRanges moved = alone(*ranges, *swing);
    const auto meets = [&](double value) {
        bool any = false;
        for (int i = 0; i < 720; ++i) {
            JointRanges there = moved;
            there.linkage.coordinates[0].low = there.linkage.coordinates[0].high = i * M_PI / 360 - M_PI;
            there.linkage.coordinates[1].low = there.linkage.coordinates[1].high = value;
            ClearanceOptions plain;
            any = any || certify(model, there, {{0, 1}}, plain).front().is_clash();
        }
        return any;
    };
    CHECK(!meets(found.above.free));
    CHECK(meets(found.above.at + 0.01));
}

}  // namespace fettle::core::clearance::ball_ranges_test
