// SPDX-License-Identifier: MIT
// Where joints are free: closed forms, starts in touch, couplings, and samples of what is called free.
#include "core/clearance/free_ranges.hpp"

#include <catch2/catch.hpp>

#include "core/clearance/range_clearance.hpp"
#include "tests/core/clearance/random_trees.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::core::clearance::free_ranges_test {

using namespace fettle::tests::mechanisms;
using scene::JointKind;
using tests::mechanisms::joint;
using tests::support::box_mesh;
using Kind = RangeEnd::Kind;

namespace {

const Vector3 z_axis = Vector3::UnitZ(), zero = Vector3::Zero();

scene::Body block(const std::string& name, const Vector3& low, const Vector3& high, bool is_static = true) {
    scene::Body out = bar(name, 0.01, zero);
    out.mesh = box_mesh(low, high);
    if (is_static) out.type = scene::BodyType::static_body;
    return out;
}

// A bar of 50 x 4 x 10 mm on a hinge at its left end, between blocks whose faces are `above` and `below` its middle.
scene::Scene swinging(double above, double below) {
    scene::Scene scene = scene_of(
        {block("arm", {0, -0.002, -0.005}, {0.05, 0.002, 0.005}, false), block("top", {-0.02, above, -0.006}, {0.08, above + 0.05, 0.006}),
         block("floor", {0.01, -below - 0.05, -0.006}, {0.08, -below, 0.006})},
        0.01);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", zero, z_axis}, {"arm", zero, z_axis})};
    return scene;
}

// The angle at which the corner (50, 2) mm of the bar is so high.
double angle_of(double height) { return std::asin(height / std::hypot(0.05, 0.002)) - std::atan2(0.002, 0.05); }

std::vector<std::pair<int, int>> all_pairs(const model::Model& model) {
    std::vector<std::pair<int, int>> out;
    for (int a = 0; a < count_of(model.bodies); ++a)
        for (int b = a + 1; b < count_of(model.bodies); ++b) out.emplace_back(a, b);
    return out;
}

std::vector<FreeRange> found_in(const scene::Scene& scene, const FreeRangeOptions& options = {}) {
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model, options.others_anywhere ? std::nullopt : std::optional(0.1));
    REQUIRE(ranges);
    std::vector<int> coordinates;
    for (int k = 0; k < count_of(ranges->linkage.coordinates); ++k) coordinates.push_back(k);
    return free_ranges(model, *ranges, coordinates, all_pairs(model), 0.1, options);
}

}  // namespace

TEST_CASE("free ranges: a bar between two blocks, by hand; its limits have no effect", "[ranges]") {
    for (const bool has_limits : {false, true}) {
        scene::Scene scene = swinging(0.01, 0.02);
        if (has_limits) scene.mechanism.joints[0].forces.limits = {-0.1, 3};
        const FreeRange found = found_in(scene).front();
        CHECK(found.start == 0);
        REQUIRE(found.above.kind == Kind::blocked);
        REQUIRE(found.below.kind == Kind::blocked);
        CHECK(found.above.free <= angle_of(0.01));
        CHECK(found.above.at >= angle_of(0.01));
        CHECK(found.above.at - found.above.free <= 1.7e-4);
        CHECK(found.above.pair->b == 1);
        CHECK(found.below.free >= -angle_of(0.02));
        CHECK(found.below.at <= -angle_of(0.02));
        CHECK(found.below.free - found.below.at <= 1.7e-4);
        CHECK(found.below.pair->b == 2);
        CHECK_FALSE(found.turns_freely);
        CHECK(found.not_searched.empty());
    }
}

TEST_CASE("free ranges: a minimum is kept, and a finer end can be asked for", "[ranges]") {
    FreeRangeOptions options;
    options.minimum = 1e-3;
    options.angle = 1e-7;
    const FreeRange found = found_in(swinging(0.01, 0.02), options).front();
    const double end = angle_of(0.009);
    CHECK(found.above.free <= end);
    CHECK(found.above.at >= end - 1e-9);
    CHECK(found.above.at - found.above.free <= 1e-7);
    CHECK(found.above.pair->upper == Approx(1e-3).margin(1e-8));
}

TEST_CASE("free ranges: what nothing stops turns all round; a slide is looked at as far as it is asked for", "[ranges]") {
    CHECK(found_in(swinging(0.06, 0.06)).front().turns_freely);
    scene::Scene scene = scene_of(
        {block("sledge", {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, false), block("stop", {0.04, -0.01, -0.01}, {0.05, 0.01, 0.01})}, 0.01);
    scene.mechanism.joints = {joint("slide", JointKind::prismatic, {"", zero, Vector3::UnitX()}, {"sledge", zero, Vector3::UnitX()})};
    const FreeRange found = found_in(scene).front();
    CHECK(found.above.kind == Kind::blocked);
    CHECK(found.above.free <= 0.03);
    CHECK(found.above.free >= 0.03 - 1e-5);
    CHECK(found.below.kind == Kind::open);
    CHECK(found.below.free == -0.1);
}

TEST_CASE("free ranges: bodies that rest on each other come apart one way", "[ranges]") {
    const FreeRange found = found_in(swinging(0.01, 0.002)).front();  // the arm lies on the floor
    REQUIRE(found.touching.size() == 1);
    CHECK(found.touching.front() == std::pair<int, int>(0, 2));
    CHECK(found.above.free >= angle_of(0.01) - 1.7e-4);
    CHECK(found.below.kind == Kind::blocked);
    CHECK(found.below.free == 0);
}

TEST_CASE("free ranges: what a joint joins may meet as assembled, anything else is free nowhere", "[ranges]") {
    scene::Scene scene = swinging(0.01, 0.02);
    scene.bodies.push_back(block("pin", {-0.003, -0.001, -0.008}, {0.003, 0.001, 0.008}));  // through the arm
    scene.bodies[0].group = scene.bodies[3].group = 7;                                      // or the scene is refused
    FreeRange found = found_in(scene).front();
    REQUIRE(found.not_searched.size() == 1);
    CHECK_FALSE(found.not_searched.front().is_joined);
    CHECK(found.above.free == 0);
    scene.mechanism.joints[0].a.body = "pin";
    scene.bodies[0].group = scene.bodies[3].group = scene.bodies[1].group;
    found = found_in(scene).front();
    REQUIRE(found.not_searched.size() == 1);
    CHECK(found.not_searched.front().is_joined);
    CHECK(found.above.free >= angle_of(0.01) - 1.7e-4);
}

TEST_CASE("free ranges: of an open body it is not known on which side the others are, and that is said") {
    // A plate within an open box: whether it is inside of it cannot be told.
    scene::Scene scene = swinging(0.06, 0.06);
    scene.bodies[1].mesh = box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
    auto triangles = scene.bodies[1].mesh.triangles;
    triangles.pop_back();
    scene.bodies[1].mesh = geometry::make_mesh("open", scene.bodies[1].mesh.vertices, triangles);
    scene.bodies[1].mesh_policy = scene::MeshPolicy::tolerant;
    const FreeRange found = found_in(scene).front();
    REQUIRE_FALSE(found.not_searched.empty());
    CHECK(found.not_searched.front().b == 1);
    CHECK_FALSE(found.not_searched.front().undecided.empty());
    CHECK(found.clash_at_start() == nullptr);
    CHECK_FALSE(found.is_decided());
}

TEST_CASE("free ranges: the other joints where they start, or anywhere within their limits", "[ranges]") {
    // A second hinge, at the first one's place, bears a bar that swings by 0.3 rad in the way of the first.
    scene::Scene scene = swinging(0.06, 0.06);
    scene.bodies.push_back(block("hand", {0.02, 0.02, -0.005}, {0.04, 0.024, 0.005}, false));
    scene.mechanism.joints.push_back(joint("other", JointKind::revolute, {"", zero, z_axis}, {"hand", zero, z_axis}));
    scene.mechanism.joints[0].forces.limits = {-1, 1};
    scene.mechanism.joints[1].forces.limits = {-0.3, 0.3};
    FreeRangeOptions options;
    const double still = found_in(scene, options).front().above.free;
    options.others_anywhere = true;
    const double anywhere = found_in(scene, options).front().above.free;
    CHECK(anywhere == Approx(still - 0.3).margin(4e-4));
}

namespace {

struct Campaign {
    int ranges = 0, ends = 0, whole_turns = 0;
    long samples = 0;
};

// Samples of what is called free are no closer than the minimum; where it ends something is.
void look_at(const tests::trees::Tree& tree, int samples, const FreeRangeOptions& options, Campaign& campaign) {
    const std::vector<int> coordinates = linked_pair(tree.ranges.linkage, tree.a, tree.b).coordinates;  // that move one against the other
    const std::vector<FreeRange> found = free_ranges(tree.model, tree.ranges, coordinates, {{tree.a, tree.b}}, 0.2, options);
    const auto joins = [&](const tests::trees::TreeJoint& joint) {
        return std::minmax(joint.parent, joint.body) == std::minmax(tree.a, tree.b);
    };
    const double kept = std::any_of(tree.joints.begin(), tree.joints.end(), joins) ? 0 : options.minimum;
    for (int k = 0; k < count_of(coordinates); ++k) {
        const FreeRange& range = found[k];
        if (!range.not_searched.empty() || !range.touching.empty()) continue;
        ++campaign.ranges;
        campaign.whole_turns += range.turns_freely;
        const auto distance = [&](double at) {
            std::vector<double> u;
            for (const auto& c : tree.ranges.linkage.coordinates) u.push_back(c.start);
            u[coordinates[k]] = at;
            return static_cast<double>(tests::trees::distance_at(tree, u));
        };
        for (int i = 0; i <= samples; ++i, ++campaign.samples)
            CHECK(distance(range.below.free + (range.above.free - range.below.free) * i / samples) >= kept);
        for (const RangeEnd* end : {&range.below, &range.above}) {
            if (end->kind != Kind::blocked) continue;
            ++campaign.ends;
            // The oracle measures surfaces that pass through each other, too: by as much as bodies move within the accuracy of an end.
            CHECK(distance(end->at) <= kept + 5e-5);
            CHECK(std::abs(end->at - end->free) <= std::max(options.angle, options.length));
        }
    }
}

}  // namespace

TEST_CASE("free ranges: no sample of random trees within a range is closer, and at its ends something is", "[ranges]") {
    std::mt19937 random(7);
    Campaign campaign;
    for (int i = 0; i < 12; ++i) look_at(tests::trees::random_tree(random), 100, {}, campaign);
    CHECK(campaign.ends > 4);
    CHECK(campaign.samples > 1000);
}

TEST_CASE("free ranges: 200 random trees, with and without a minimum", "[ranges][slow]") {
    std::mt19937 random(11);
    Campaign campaign;
    for (int i = 0; i < 200; ++i) {
        FreeRangeOptions options;
        if (i % 2 == 1) options.minimum = 2e-3;
        look_at(tests::trees::random_tree(random), 200, options, campaign);
    }
    CHECK(campaign.ends > 60);
    CHECK(campaign.whole_turns > 0);
    WARN(campaign.ranges << " ranges, " << campaign.ends << " ends, " << campaign.samples << " samples");
}

}  // namespace fettle::core::clearance::free_ranges_test
