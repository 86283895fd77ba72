// SPDX-License-Identifier: MIT
// Joints that fits propose, of parts whose joints are known.
#include "core/features/joint_proposals.hpp"

#include <catch2/catch.hpp>

#include "core/features/find_features.hpp"
#include "tests/core/features/known_parts.hpp"

namespace fettle::core::features::joint_proposals_test {

using namespace known_parts;  // NOLINT(google-build-using-namespace)

namespace {

struct Assembly {
    std::vector<geometry::Mesh> placed;
    std::vector<Features> parts;
    std::vector<Fit> fits;

    void add(const std::function<Result<Solid>(Drawing&)>& part) {
        placed.push_back(drawn_mesh(part));
        parts.push_back(find_features(placed.back()));
    }
    std::vector<ProposedJoint> joints() {
        fits = find_fits(parts);
        return propose_joints(placed, parts, fits, proposed_ground(placed));
    }
    std::vector<ProposedJoint> joints(int ground) {
        fits = find_fits(parts);
        return propose_joints(placed, parts, fits, ground);
    }
};

// A plate from z = 0 with bores.
Result<Solid> plate(Drawing& drawing, double size, double height, const std::vector<Point2>& bores, double radius) {
    std::vector<Loop> holes;
    for (const Point2& at : bores) holes.push_back(circle(at, radius, "bore"));
    return extruded(drawing, *with_holes(*filled(rectangle({-size / 2, -size / 2}, size, size, "plate")), holes), 0, height);
}

Result<Solid> pin(Drawing& drawing, double radius, double from, double to, const Point2& at = {}) {
    return extruded(drawing, *filled(circle(at, radius, "pin")), from, to);
}

// Along z, with heads: [from, to] is the shaft.
Result<Solid> headed_pin(Drawing& drawing, double radius, double from, double to, bool below, bool above) {
    const Profile shaft = *filled(circle({}, radius, "pin")), head = *filled(circle({}, 2 * radius, "head"));
    std::vector<Layer> layers;
    if (below) layers.push_back({head, from - 2 * mm, from, {}, {}, "low head"});
    layers.push_back({shaft, from, to, {}, {}, "shaft"});
    if (above) layers.push_back({head, to, to + 2 * mm, {}, {}, "high head"});
    return stacked(drawing, layers);
}

}  // namespace

TEST_CASE("one line: cylindrical, with shoulders on both sides revolute") {
    struct Case {
        bool below, above;
        JointKind kind;
    };
    for (const Case& c : {Case{false, false, JointKind::cylindrical}, Case{true, false, JointKind::cylindrical},
                          Case{false, true, JointKind::cylindrical}, Case{true, true, JointKind::revolute}}) {
        Assembly assembly;
        assembly.add([](Drawing& d) { return plate(d, 30 * mm, 6 * mm, {{}}, 2.1 * mm); });
        assembly.add([&](Drawing& d) { return headed_pin(d, 2 * mm, -0.2 * mm, 6.3 * mm, c.below, c.above); });
        const std::vector<ProposedJoint> joints = assembly.joints();
        REQUIRE(joints.size() == 1);
        CHECK(joints[0].a == 0);
        CHECK(joints[0].b == 1);
        CHECK(joints[0].kind == c.kind);
        CHECK(std::abs(joints[0].axis.z()) == Approx(1));
        CHECK(joints[0].point.head<2>().norm() < 1e-6);
        // The low head stops the pin on its way up.
        const double up = joints[0].axis.z();
        CHECK(joints[0].stops[up > 0 ? 1 : 0].has_value() == c.below);
        CHECK(joints[0].stops[up > 0 ? 0 : 1].has_value() == c.above);
        if (c.below) CHECK(joints[0].stops[up > 0 ? 1 : 0]->gap == Approx(0.2 * mm));
        if (c.above) CHECK(joints[0].stops[up > 0 ? 0 : 1]->gap == Approx(0.3 * mm));
        CHECK(assembly.joints(1).front().a == 1);  // the other stands
        CHECK(assembly.joints(1).front().kind == c.kind);
    }
}

TEST_CASE("a hinge: the lid turns against the base, through a pin that slides") {
    Assembly assembly;
    const auto leaf = [](double low, double high) {
        return [=](Drawing& d) {
            const auto knuckle = with_hole(*filled(circle({}, 5 * mm, "rim")), circle({}, 2.1 * mm, "bore"));
            return extruded(d, *knuckle, low, high);
        };
    };
    assembly.add([](Drawing& d) {  // two knuckles on a plate beside them
        const auto knuckle = with_hole(*filled(rectangle({-5 * mm, -30 * mm}, 10 * mm, 35 * mm, "leaf")), circle({}, 2.1 * mm, "bore"));
        const auto back = filled(rectangle({-5 * mm, -30 * mm}, 10 * mm, 20 * mm, "back"));
        return stacked(
            d,
            {{*knuckle, 0, 8 * mm, {}, {}, "low"}, {*back, 8 * mm, 20 * mm, {}, {}, "back"}, {*knuckle, 20 * mm, 28 * mm, {}, {}, "high"}});
    });
    assembly.add(leaf(8.3 * mm, 19.7 * mm));
    assembly.add([](Drawing& d) { return pin(d, 2 * mm, -1 * mm, 29 * mm); });
    const std::vector<ProposedJoint> joints = assembly.joints();
    REQUIRE(joints.size() == 2);
    CHECK(joints[0].b == 1);
    CHECK(joints[0].kind == JointKind::revolute);
    CHECK(joints[1].b == 2);
    CHECK(joints[1].kind == JointKind::cylindrical);
    for (const ProposedJoint& joint : joints) CHECK(joint.a == 0);
    CHECK(joints[0].fits.size() == 3);
}

TEST_CASE("two parallel lines: prismatic; stopped both ways: fixed") {
    for (const bool stopped : {false, true}) {
        Assembly assembly;
        const std::vector<Point2> at{{-8 * mm, 0}, {8 * mm, 0}};
        assembly.add([&](Drawing& d) { return plate(d, 40 * mm, 6 * mm, at, 2.1 * mm); });
        assembly.add([&](Drawing& d) {
            const Profile pins = *together({*filled(circle(at[0], 2 * mm, "a")), *filled(circle(at[1], 2 * mm, "b"))});
            const Profile bar = *filled(rectangle({-12 * mm, -3 * mm}, 24 * mm, 6 * mm, "bar"));
            std::vector<Layer> layers{{bar, -4 * mm, -0.3 * mm, {}, {}, "bar"}, {pins, -0.3 * mm, 6.3 * mm, {}, {}, "pins"}};
            if (stopped) layers.push_back({bar, 6.3 * mm, 9 * mm, {}, {}, "top"});
            return stacked(d, layers);
        });
        const std::vector<ProposedJoint> joints = assembly.joints();
        REQUIRE(joints.size() == 1);
        CHECK(joints[0].kind == (stopped ? JointKind::fixed : JointKind::prismatic));
        CHECK(std::abs(joints[0].axis.z()) == Approx(1));
        CHECK(joints[0].fits.size() == 2);
    }
}

TEST_CASE("a ball in a socket; a press fit; the end of a slot; nothing") {
    Assembly ball;
    ball.add([](Drawing& d) {
        const auto block = extruded(d, *filled(rectangle({-10 * mm, -10 * mm}, 20 * mm, 20 * mm, "block")), -10 * mm, 4 * mm);
        return difference(d, *block, *sphere(d, 5.2 * mm, "socket"));
    });
    ball.add([](Drawing& d) { return sphere(d, 5 * mm, "ball"); });
    const std::vector<ProposedJoint> of_ball = ball.joints();
    REQUIRE(of_ball.size() == 1);
    CHECK(of_ball[0].kind == JointKind::ball);
    CHECK(of_ball[0].point.norm() < 1e-5);

    Assembly pressed;
    pressed.add([](Drawing& d) { return plate(d, 30 * mm, 6 * mm, {{}}, 2 * mm); });
    pressed.add([](Drawing& d) { return pin(d, 2.02 * mm, -1 * mm, 7 * mm); });
    const std::vector<ProposedJoint> of_press = pressed.joints();
    REQUIRE(of_press.size() == 1);
    CHECK(of_press[0].kind == JointKind::fixed);
    CHECK(of_press[0].is_pressed);

    Assembly slotted;
    slotted.add([](Drawing& d) {
        return extruded(
            d,
            *with_hole(*filled(rectangle({-15 * mm, -15 * mm}, 30 * mm, 30 * mm, "plate")), slot({-5 * mm, 0}, {0, 0}, 2.1 * mm, "slot")),
            0, 6 * mm);
    });
    slotted.add([](Drawing& d) { return pin(d, 2 * mm, -1 * mm, 7 * mm); });
    CHECK(slotted.joints().empty());

    Assembly apart;
    apart.add([](Drawing& d) { return plate(d, 30 * mm, 6 * mm, {{}}, 2.1 * mm); });
    apart.add([](Drawing& d) { return pin(d, 2 * mm, -1 * mm, 7 * mm, {40 * mm, 0}); });
    CHECK(apart.joints().empty());
}

TEST_CASE("a drawer between walls: prismatic along what is left") {
    for (const bool closed : {false, true}) {
        Assembly assembly;
        assembly.add([&](Drawing& d) {  // a channel along z, round a square
            const auto tube = with_hole(*filled(rectangle({-15 * mm, -15 * mm}, 30 * mm, 30 * mm, "tube")),
                                        rectangle({-10.2 * mm, -10.2 * mm}, 20.4 * mm, 20.4 * mm, "channel"));
            const Profile lid = *filled(rectangle({-15 * mm, -15 * mm}, 30 * mm, 30 * mm, "tube"));
            std::vector<Layer> layers{{*tube, 0, 40 * mm, {}, {}, "tube"}};
            if (closed) layers = {{lid, -3 * mm, 0, {}, {}, "floor"}, layers[0], {lid, 40 * mm, 43 * mm, {}, {}, "roof"}};
            return stacked(d, layers);
        });
        assembly.add([](Drawing& d) {
            return extruded(d, *filled(rectangle({-10 * mm, -10 * mm}, 20 * mm, 20 * mm, "drawer")), 0.3 * mm, 39.7 * mm);
        });
        const std::vector<ProposedJoint> joints = assembly.joints();
        REQUIRE(joints.size() == 1);
        CHECK(joints[0].kind == (closed ? JointKind::fixed : JointKind::prismatic));
        if (!closed) CHECK(joints[0].axis.z() == Approx(1));
        CHECK(joints[0].guides.size() == (closed ? 6 : 4));
    }
}

TEST_CASE("flat faces that face each other: the gap, and only where they overlap") {
    Assembly assembly;
    assembly.add([](Drawing& d) { return plate(d, 20 * mm, 2 * mm, {}, 1); });
    assembly.add([](Drawing& d) {
        return extruded(d, *filled(rectangle({-5 * mm, -5 * mm}, 10 * mm, 10 * mm, "block")), 2.5 * mm, 6 * mm);
    });
    assembly.add([](Drawing& d) {
        return extruded(d, *filled(rectangle({10 * mm, -5 * mm}, 10 * mm, 10 * mm, "beside")), 2.5 * mm, 6 * mm);
    });
    const auto facing = [&](int a, int b, double most) {
        return facing_planes(assembly.placed[a], assembly.parts[a], assembly.placed[b], assembly.parts[b], most);
    };
    const std::vector<Facing> faces = facing(0, 1, 1 * mm);
    REQUIRE(faces.size() == 1);
    CHECK(faces[0].gap == Approx(0.5 * mm));
    CHECK(faces[0].normal.z() == Approx(1));
    CHECK(facing(1, 0, 1 * mm).front().normal.z() == Approx(-1));
    CHECK(facing(0, 1, 0.4 * mm).empty());
    CHECK(facing(0, 2, 1 * mm).empty());  // side by side, seen from above
}

}  // namespace fettle::core::features::joint_proposals_test
