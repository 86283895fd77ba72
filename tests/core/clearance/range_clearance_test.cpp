// SPDX-License-Identifier: MIT
// Clearance over all positions of joints: closed forms, samples of random trees in extended precision.
#include "core/clearance/range_clearance.hpp"

#include <chrono>
#include <sstream>

#include "core/clearance/range_bound.hpp"
#include "tests/core/clearance/random_trees.hpp"

namespace fettle::core::clearance::range_clearance_test {

using namespace fettle::tests::mechanisms;
using namespace fettle::tests::trees;
using fettle::tests::clearance::Real;

namespace {

const Vector3 z_axis = Vector3::UnitZ();

// Two links in a plane, 60 and 40 mm long, 12 mm wide; a post of 20 mm on the x axis whose face is `post` from the shoulder.
scene::Scene arm_and_post(double post) {
    scene::Body upper = bar("upper", 0.06, Vector3::Zero(), Vector3(0, 0, M_PI / 2), 0.006),
                fore = bar("fore", 0.04, Vector3(0, 0.06, 0), Vector3(0, 0, M_PI / 2), 0.006),
                block = bar("post", 0.02, Vector3(post, 0, 0));
    block.type = scene::BodyType::static_body;
    scene::Scene scene = scene_of({upper, fore, block}, 0.01);
    scene.mechanism.joints = {
        tests::mechanisms::joint("shoulder", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"upper", Vector3::Zero(), z_axis}),
        tests::mechanisms::joint("elbow", JointKind::revolute, {"upper", Vector3(0.06, 0, 0), z_axis}, {"fore", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].forces.limits = {-1.8, 0.5};
    scene.mechanism.joints[1].forces.limits = {-2, 0.1};
    return scene;
}

PairClearance certified(const scene::Scene& scene, int a, int b, double tolerance, double minimum = 0) {
    const model::Model model = built(scene);
    const auto ranges = joint_ranges(model);
    REQUIRE(ranges);
    ClearanceOptions options;
    options.tolerance = tolerance;
    return certify(model, *ranges, {{a, b, minimum}}, options).front();
}

double size_of(const Tree& tree) { return tree.model.bodies[tree.a].radius + tree.model.bodies[tree.b].radius; }

PairClearance certified(const Tree& tree, double tolerance) {
    ClearanceOptions options;
    options.tolerance = tolerance;
    return certify(tree.model, tree.ranges, {{tree.a, tree.b}}, options).front();
}

// All of the linkage, the pair's own at the witness.
std::vector<double> at_witness(const Tree& tree, const PairClearance& found) {
    std::vector<double> u;
    for (const auto& c : tree.ranges.linkage.coordinates) u.push_back(c.start);
    for (std::size_t k = 0; k < found.coordinates.size(); ++k) u[found.coordinates[k]] = found.at[k];
    return u;
}

struct Campaign {
    int trees = 0, clashes = 0;
    long samples = 0, below = 0;
    std::array<int, most_coordinates + 1> by_coordinates{};
    int geared = 0;                                           // of the trees: some coordinate of the pair moves two joints or more
    std::array<double, most_coordinates + 1> widest{};        // upper - lower [m]
    std::array<double, most_coordinates + 1> widest_share{};  // of the bodies' size
    double longest = 0;                                       // [s]
};

// Bounds as close as was asked for, no sample below them, the upper one attained.
void look_at(const Tree& tree, int samples, std::mt19937& random, Campaign& campaign) {
    const int count = pair_coordinates(tree);
    if (count > most_coordinates) return;
    const double tolerance = count <= 2 ? 1e-5 : 0.01 * size_of(tree);
    const auto begin = std::chrono::steady_clock::now();
    const PairClearance found = certified(tree, tolerance);
    campaign.longest = std::max(campaign.longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    CAPTURE(count, found.lower, found.upper, found.bounds);
    if (found.is_clash()) {
        ++campaign.clashes;
        return;
    }
    ++campaign.trees;
    const auto k = static_cast<std::size_t>(count);
    ++campaign.by_coordinates[k];
    campaign.widest[k] = std::max(campaign.widest[k], found.upper - found.lower);
    campaign.widest_share[k] = std::max(campaign.widest_share[k], (found.upper - found.lower) / size_of(tree));
    campaign.geared += std::any_of(found.coordinates.begin(), found.coordinates.end(),
                                   [&](int c) { return tree.ranges.linkage.coordinates[c].joints.size() > 1; });
    CHECK(found.complete);
    CHECK(found.upper - found.lower <= tolerance);
    const std::vector<double> worst = at_witness(tree, found);
    CHECK(static_cast<double>(distance_at(tree, worst)) <= found.upper);
    CHECK(static_cast<double>(distance_at(tree, worst)) >= found.upper - 1e-9);
    for (int i = 0; i < samples; ++i) {
        std::vector<double> u = random_coordinates(tree, random);
        if (i % 2 == 1) {  // near the worst, too
            const double share = std::pow(10, -std::uniform_real_distribution<double>(0, 6)(random));
            for (std::size_t k = 0; k < u.size(); ++k) u[k] = worst[k] + share * (u[k] - worst[k]);
        }
        ++campaign.samples;
        if (distance_at(tree, u) < found.lower) ++campaign.below;
    }
}

}  // namespace

TEST_CASE("ranges: a two-link arm that reaches for a post, its worst combination by hand", "[ranges]") {
    // The hand's farthest corner is hypot(40, 6) from the elbow; stretched out towards the post it is 60 mm further.
    const double reach = 0.06 + std::hypot(0.04, 0.006), post = 0.11;
    const PairClearance found = certified(arm_and_post(post), 1, 2, 1e-6);
    CAPTURE(found.bounds);
    CHECK(found.lower <= post - reach);
    CHECK(found.upper >= post - reach - 1e-15);
    CHECK(found.upper - found.lower <= 1e-6);
    CHECK(found.status == PairStatus::clear);
    REQUIRE(found.at.size() == 2);
    CHECK(found.at[0] == Approx(-M_PI / 2).margin(1e-2));  // the coordinates themselves are only as good as the square root
    CHECK(found.at[1] == Approx(-std::atan2(0.006, 0.04)).margin(2e-2));
    CHECK(found.witness.point_a.x() == Approx(reach).margin(1e-6));
    CHECK(found.witness.point_b.x() == Approx(post).margin(1e-12));
}

TEST_CASE("ranges: worst at a limit of one joint, inside the range of the other", "[ranges]") {
    // The elbow stops at -1: of the hand's corners the one at (40, -6) from the elbow stretches the arm most. Its distance from the
    // shoulder does not depend on the shoulder, which turns it to face the post.
    scene::Scene scene = arm_and_post(0.11);
    scene.mechanism.joints[1].forces.limits = {-2, -1};
    scene.bodies[1].pose.rotation = kinematics::rotation(Vector3(0, 0, M_PI / 2 - 1.5));
    scene.mechanism.joints[1].forces.limits = {-0.5, 0.5};  // from a start at -1.5
    const double elbow = -1.0;
    const Vector3 corner = Vector3(0.06, 0, 0) + kinematics::rotation(Vector3(0, 0, elbow)) * Vector3(0.04, 0.006, 0);
    const PairClearance found = certified(scene, 1, 2, 1e-6);
    CAPTURE(found.at[0], found.at[1]);
    CHECK(found.lower <= 0.11 - corner.norm());
    CHECK(found.upper >= 0.11 - corner.norm() - 1e-15);
    CHECK(found.upper - found.lower <= 1e-6);
    CHECK(found.at[1] == Approx(0.5).margin(1e-6));
}

TEST_CASE("ranges: a reach that is too long is a clash, a minimum is judged, layers cost nothing", "[ranges]") {
    const PairClearance clash = certified(arm_and_post(0.09), 1, 2, 1e-6);
    CHECK(clash.intersecting);
    CHECK(clash.status == PairStatus::violated);
    CHECK(clash.lower == 0);
    CHECK(certified(arm_and_post(0.11), 1, 2, 1e-4, 0.0095).status == PairStatus::clear);
    CHECK(certified(arm_and_post(0.11), 1, 2, 1e-4, 0.0096).status == PairStatus::violated);
    // 2 mm above the arm, whatever it does.
    scene::Scene layers = arm_and_post(0.05);
    layers.bodies[2].pose.position.z() = 0.006 + 0.01 + 0.002;
    const PairClearance above = certified(layers, 1, 2, 1e-6);
    CHECK(above.lower == Approx(0.002).margin(1e-6));
    CHECK(above.upper == Approx(0.002).margin(1e-6));
    CHECK(above.bounds < 2000);
}

TEST_CASE("ranges: a clash is told where it is deep, not where it begins", "[ranges]") {
    // A bar on a hinge goes into a wide block beside it, the deeper the farther it turns.
    scene::Body arm = bar("arm", 0.05, Vector3::Zero()), block = bar("block", 0.05, Vector3::Zero());
    arm.mesh = tests::support::box_mesh({0, -0.002, -0.005}, {0.05, 0.002, 0.005});
    block.mesh = tests::support::box_mesh({-0.02, 0.01, -0.006}, {0.08, 0.06, 0.006});
    block.type = scene::BodyType::static_body;
    scene::Scene scene = scene_of({arm, block}, 0.01);
    scene.mechanism.joints = {
        tests::mechanisms::joint("hinge", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"arm", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].forces.limits = {-0.5, 0.5};
    const PairClearance found = certified(scene, 0, 1, 1e-6);
    REQUIRE(found.is_clash());
    REQUIRE(found.at.size() == 1);
    CHECK(found.at[0] == Approx(0.5).margin(1e-9));
    REQUIRE(found.overlap);
    // The part of the arm that is higher than the block's face: its ends along the arm are at that height over sin(0.5).
    const double above = 4e-3 * 10e-3 * (0.05 - 0.01 / std::sin(0.5));
    CHECK(found.overlap->volume_lower == Approx(above).epsilon(1e-6));
}

TEST_CASE("ranges: one body within the other's material is a clash", "[ranges]") {
    scene::Scene scene = arm_and_post(0.11);
    scene.bodies[2].mesh = tests::support::box_mesh(Vector3(-1, -1, -1), Vector3(1, 1, 1));
    const PairClearance found = certified(scene, 1, 2, 1e-5);
    CHECK(found.solids == Solids::overlap);
    CHECK(found.status == PairStatus::violated);
}

TEST_CASE("ranges: too many coordinates are told, not dealt with", "[ranges]") {
    std::vector<scene::Body> bodies;
    scene::Scene scene = scene_of({}, 0.01);
    for (int i = 0; i < 8; ++i) scene.bodies.push_back(bar("b" + std::to_string(i), 0.1, Vector3(0.1 * i, 0, 0)));
    for (int i = 1; i < 8; ++i)
        scene.mechanism.joints.push_back(tests::mechanisms::joint("j" + std::to_string(i), JointKind::revolute,
                                                                  {"b" + std::to_string(i - 1), Vector3(0.1, 0, 0), z_axis},
                                                                  {"b" + std::to_string(i), Vector3::Zero(), z_axis}));
    const PairClearance found = certified(scene, 0, 7, 1e-5);
    CHECK(found.status == PairStatus::undecided);
    CHECK(tests::support::contains(found.reason, "7 coordinates"));
}

TEST_CASE("ranges: no sampled combination of random trees is below the bound", "[ranges]") {
    std::mt19937 random(17);
    Campaign campaign;
    while (campaign.trees < 8) look_at(random_tree(random), 200, random, campaign);
    CHECK(campaign.samples == 1600);
    CHECK(campaign.below == 0);
}

TEST_CASE("ranges: a bound without its losses is found out", "[ranges]") {
    std::mt19937 random(23);
    long below = 0;
    for (int i = 0; i < 30 && below == 0; ++i) {
        const Tree tree = random_tree(random);
        const int count = pair_coordinates(tree);
        if (count < 1 || count > 2) continue;
        const auto shape = [&](int body) {
            const model::Body& b = tree.model.bodies[body];
            return make_piece_tree(b.mesh, *b.hierarchy);
        };
        const PieceTree a = shape(tree.a), b = shape(tree.b);
        const ScrewedPair pair = screwed_pair(a, b, tree.ranges.linkage, linked_pair(tree.ranges.linkage, tree.a, tree.b),
                                              tree.model.bodies[tree.a].pose_start, tree.model.bodies[tree.b].pose_start);
        // The best that the whole box proves, without its losses: more than is there.
        const BoxBound whole(pair, pair.ranges);
        const Vector3 n = Vector3(kinematics::world_position(whole.middle_a(), a.pieces[0].center) -
                                  kinematics::world_position(whole.middle_b(), b.pieces[0].center))
                              .normalized() *
                          (1 - 1e-15);
        double claimed = std::numeric_limits<double>::infinity();
        for (int c = 0; c < 1 << count; ++c) {  // a corner alone loses nothing
            CoordinateBox corner = pair.ranges;
            for (int k = 0; k < count; ++k) {
                const auto i = static_cast<std::size_t>(k);
                (c >> k & 1 ? corner.low : corner.high)[i] = (c >> k & 1 ? corner.high : corner.low)[i];
            }
            claimed = std::min(claimed, BoxBound(pair, corner).along(n, a.pieces[0], b.pieces[0], nullptr, nullptr).lower);
        }
        for (int k = 0; k < 2000 && claimed > 0; ++k)
            if (distance_at(tree, random_coordinates(tree, random)) < claimed) ++below;
    }
    CHECK(below > 0);
}

TEST_CASE("ranges: 100 random trees, 100,000 sampled combinations", "[ranges][slow]") {
    std::mt19937 random(1);
    Campaign campaign;
    while (campaign.trees < 100) look_at(random_tree(random), 1000, random, campaign);
    for (std::size_t k = 1; k < campaign.by_coordinates.size(); ++k) CHECK(campaign.by_coordinates[k] >= 5);
    CHECK(campaign.samples == 100'000);
    CHECK(campaign.below == 0);
    CHECK(campaign.geared >= 5);
    std::ostringstream told;
    for (std::size_t k = 0; k < campaign.by_coordinates.size(); ++k)
        told << "; " << campaign.by_coordinates[k] << " of " << k << " coordinates, bounds at most " << campaign.widest[k] << " m apart, "
             << campaign.widest_share[k] << " of the size";
    WARN(campaign.clashes << " more trees clash; " << campaign.geared << " are geared; " << campaign.longest << " s for the slowest"
                          << told.str());
}

TEST_CASE("ranges: flush parts that overlap are a clash, though no edge passes through a face", "[clearance][ranges]") {
    // A pin on a wheel of radius 60 mm, 2 mm wide, and a post of 3 mm in its way at 33 degrees; both from z = -5 to 5 mm.
    for (const double low : {-0.15, -3.0})
        for (const double place : {33.0, -20.0, 40.0}) {
            const auto at = [](double degrees) {
                return Vector3(0.06 * std::cos(degrees * M_PI / 180), 0.06 * std::sin(degrees * M_PI / 180), 0);
            };
            scene::Body pin = bar("pin", 0.004, at(0)), post = bar("post", 0.003, at(place));
            pin.mesh = tests::support::box_mesh({-0.002, -0.001, -0.005}, {0.002, 0.001, 0.005});
            post.mesh = tests::support::box_mesh({-0.0015, -0.0015, -0.005}, {0.0015, 0.0015, 0.005});
            post.type = scene::BodyType::static_body;
            scene::Scene scene = scene_of({pin, post}, 0.01);
            for (scene::Body& body : scene.bodies) body.group = -1;
            scene.mechanism.joints = {
                tests::mechanisms::joint("j", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"pin", -at(0), z_axis})};
            scene.mechanism.joints[0].forces.limits = {low, 1.5};
            const PairClearance found = certified(scene, 0, 1, 1e-6);
            const bool meets = place * M_PI / 180 > low;
            CAPTURE(low, place, found.lower, found.upper, found.reason);
            CHECK(found.is_clash() == meets);
            CHECK(found.status == (meets ? PairStatus::violated : PairStatus::clear));
            if (!meets) continue;
            REQUIRE(found.overlap);
            CHECK(found.overlap->depth_lower > 1e-4);
            CHECK(found.overlap->volume_upper <= 4e-3 * 2e-3 * 10e-3 * (1 + 1e-6));
            CHECK(std::abs(found.at[0] - place * M_PI / 180) < 0.06);
        }
}

}  // namespace fettle::core::clearance::range_clearance_test
