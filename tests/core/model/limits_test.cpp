// SPDX-License-Identifier: MIT
// Limits are closed: every kind of joint that has them x where it starts against them x what is asked. docs/method/joints.md.
#include "core/model/limits.hpp"

#include <catch2/catch.hpp>

#include "core/base/text.hpp"
#include "core/clearance/joint_ranges.hpp"
#include "core/stepper/jointed_motion.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::model::limits_test {

using namespace fettle::tests::mechanisms;
using fettle::tests::support::contains;
using scene::Integrator;
using scene::JointKind;
using stepper::SimulationStatus;

namespace {

const Vector3 z_axis = Vector3::UnitZ();
constexpr double range = 0.5;  // [rad], [m]

enum class Place { at_lower, at_upper, just_inside, rounding_outside, beyond, far_beyond };
constexpr std::array places{Place::at_lower,         Place::at_upper, Place::just_inside,
                            Place::rounding_outside, Place::beyond,   Place::far_beyond};
constexpr std::array kinds{JointKind::revolute, JointKind::prismatic, JointKind::cylindrical, JointKind::screw};

bool may_start(Place place) { return place != Place::beyond && place != Place::far_beyond; }

std::array<double, 2> limits_at(Place place) {
    switch (place) {
        case Place::at_lower:
            return {0, range};
        case Place::at_upper:
            return {-range, 0};
        case Place::just_inside:
            return {-1e-9, range};
        case Place::rounding_outside:
            return {1.6e-15, range};
        case Place::beyond:
            return {0.003, range};
        case Place::far_beyond:
            break;
    }
    return {0.2, range};
}

// From the limit inwards.
double inwards(Place place) { return place == Place::at_upper ? -1 : 1; }

scene::Joint of_kind(JointKind kind, const std::string& name, const std::string& body, const Vector3& at) {
    scene::Joint out = joint(name, kind, {"", at, z_axis}, {body, Vector3::Zero(), z_axis});
    out.pitch = 0.02;
    return out;
}

// A bar on a joint, and where `ratio` is not 0 a second one that is geared to it and has the limits in its place.
scene::Scene limited(JointKind kind, const std::array<double, 2>& limits, Integrator integrator, double ratio = 0) {
    scene::Scene scene = scene_of({bar("one", 0.3)}, 0.01);
    scene.integrator = integrator;
    scene.mechanism.joints = {of_kind(kind, "drive", "one", Vector3::Zero())};
    if (ratio == 0) {
        scene.mechanism.joints[0].forces.limits = limits;
        return scene;
    }
    scene.bodies.push_back(bar("two", 0.3, Vector3(0, 1, 0)));
    scene.bodies.back().group = 0;
    const bool is_angle = kind == JointKind::revolute || kind == JointKind::screw;
    scene.mechanism.joints.push_back(of_kind(is_angle ? kind : JointKind::revolute, "follower", "two", Vector3(0, 1, 0)));
    scene.mechanism.joints[1].forces.limits = limits;
    if (!is_angle) std::swap(scene.mechanism.joints[0].forces, scene.mechanism.joints[1].forces);
    scene::Joint coupling = joint("coupling", is_angle ? JointKind::gear : JointKind::rack, {}, {});
    coupling.of = {is_angle ? "drive" : "follower", is_angle ? "follower" : "drive"};
    coupling.ratio = ratio;
    scene.mechanism.joints.push_back(coupling);
    return scene;
}

double coordinate(const Model& model, const stepper::Simulation& out, const std::string& name) {
    for (const Joint& joint : model.mechanism.joints)
        if (joint.name == name && !joint.is_motor)
            return value_of(model.mechanism.set.measures[joint.coordinate],
                            placed(model.mechanism.set.frames, out.trajectory.poses.back()));
    FAIL("no joint " << name);
    return 0;
}

void push(scene::Scene& scene, double effort) {
    scene::Motor out = motor("push", "drive", {});
    out.kind = scene::MotorKind::effort;
    out.curve.times = {0};
    out.curve.values = {effort};
    scene.mechanism.motors = {out};
}

void lead(scene::Scene& scene, double by) {
    scene::Curve curve;
    curve.times = {0, 0.2};
    curve.values = {0, by};
    scene.mechanism.motors = {motor("lead", "drive", curve)};
}

stepper::Simulation simulated(const Model& model, int steps) {
    stepper::SimulationOptions options;
    options.steps = steps;
    options.outputs = true;
    return stepper::simulate(model, options);
}

}  // namespace

TEST_CASE("limits: every joint, start and integrator: at rest it stays, pressed it holds, beyond it is refused by name", "[limits]") {
    for (const JointKind kind : kinds)
        for (const Place place : places)
            for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::quasi_static}) {
                CAPTURE(static_cast<int>(kind), static_cast<int>(place), static_cast<int>(integrator));
                const std::array<double, 2> limits = limits_at(place);
                scene::Scene scene = limited(kind, limits, integrator);
                if (!may_start(place)) {
                    const auto refused = setup::build_model(scene);
                    REQUIRE(!refused);
                    CHECK(contains(refused.errors()[0].message, "`drive` is at 0 "));
                    CHECK(contains(refused.errors()[0].message, "beyond its limits"));
                    continue;
                }
                const bool is_static = integrator == Integrator::quasi_static;
                if (!is_static) {
                    const Model model = built(scene);
                    const auto rest = run(model, 5);
                    CHECK(std::abs(coordinate(model, rest, "drive")) < 1e-12);
                    CHECK(rest.balance->energy_start < 1e-20);
                    CHECK(std::isfinite(rest.balance->energy_end));
                }
                push(scene, -0.02 * inwards(place));
                const Model model = built(scene);
                const auto pressed = run(model, 60, true);
                const double at = coordinate(model, pressed, "drive"), give = stop_give * model.dhat / model.mechanism.terms[0].length;
                CHECK(std::abs(at) < give);
                if (is_static) CHECK(inwards(place) * at < 0);
                if (is_static) CHECK(std::abs(pressed.outputs.back().joints[0].stop) == Approx(0.02).epsilon(1e-6));
                if (is_static) continue;
                push(scene, 0.02 * inwards(place));
                const Model off = built(scene);
                CHECK(inwards(place) * coordinate(off, run(off, 5), "drive") > 0);
            }
}

TEST_CASE("limits: a motor leads from one limit to the other, and is blocked beyond it, with the joint's name", "[limits]") {
    for (const JointKind kind : kinds)
        for (const double ratio : {0.0, 1.0, -1.0, 2.0})
            for (const bool at_lower : {true, false}) {
                CAPTURE(static_cast<int>(kind), ratio, at_lower);
                if (ratio != 0 && kind == JointKind::cylindrical) continue;  // nothing is geared to it
                const double sense = (ratio < 0 ? -1 : 1) * (at_lower ? 1 : -1), whole = range / std::max(1.0, std::abs(ratio));
                const bool is_rack = ratio != 0 && kind == JointKind::prismatic;
                const double way = is_rack ? sense * range : sense * whole;
                scene::Scene scene =
                    limited(kind, at_lower ? std::array{0.0, range} : std::array{-range, 0.0}, Integrator::implicit_euler, ratio);
                if (is_rack) {
                    scene.mechanism.joints[0].forces.limits.reset();
                    scene.mechanism.joints[0].forces.limits = ratio > 0 == at_lower ? std::array{0.0, range} : std::array{-range, 0.0};
                }
                lead(scene, way);
                const Model model = built(scene);
                const auto out = simulated(model, 20);
                INFO(out.report.message);
                CHECK(out.report.status == SimulationStatus::ok);
                const bool is_held = kind != JointKind::cylindrical;  // it turns freely
                CHECK((!is_held || stepper::follow_joints(model, 20, 1e-3)));
                lead(scene, -way);
                const Model against = built(scene);
                const auto blocked = simulated(against, 20);
                CHECK(blocked.report.status == SimulationStatus::blocked);
                CHECK(contains(blocked.report.message, ratio == 0 || is_rack ? "'drive' is at its" : "'follower' is at its"));
                const auto beyond = stepper::follow_joints(against, 20, 1e-3);
                REQUIRE(!beyond);
                if (is_held) CHECK(contains(beyond.errors()[0].message, "beyond its limits"));
            }
}

TEST_CASE("limits: ranges take every start that a simulation takes, and name limits of followers that narrow a range", "[limits]") {
    for (const JointKind kind : kinds)
        for (const Place place : places) {
            CAPTURE(static_cast<int>(kind), static_cast<int>(place));
            if (!may_start(place)) continue;
            const std::array<double, 2> limits = limits_at(place);
            scene::Scene scene = limited(kind, limits, Integrator::implicit_euler);
            const Model model = built(scene);
            const auto ranges = clearance::joint_ranges(model);
            REQUIRE(ranges);
            const auto& c = ranges->linkage.coordinates[0];
            CHECK(c.low <= c.start);
            CHECK(c.start <= c.high);
            CHECK(c.low == Approx(limits[0]).margin(1e-12));
            CHECK(c.high == Approx(limits[1]).margin(1e-12));
            CHECK(ranges->narrowed.empty());
            CHECK(ranges->lost.empty());
            if (kind != JointKind::revolute && kind != JointKind::screw) continue;
            for (const double ratio : {1.0, -1.0, 0.5}) {
                scene::Scene geared = limited(kind, limits, Integrator::implicit_euler, ratio);
                geared.mechanism.joints[0].forces.limits = {-range, range};
                const Model both = built(geared);
                const auto narrowed = clearance::joint_ranges(both);
                REQUIRE(narrowed);
                CHECK(narrowed->narrowed.size() == 1);
                CHECK(contains(base::joined(narrowed->narrowed), "`follower` narrows it"));
                // The drive's own limits the other way round leave one pose.
                geared.mechanism.joints[0].forces.limits =
                    (limits[0] < -0.1) == (ratio > 0) ? std::array{-1e-9, range} : std::array{-range, 1e-9};
                const Model one = built(geared);
                const auto none = clearance::joint_ranges(one);
                REQUIRE(none);
                CHECK(none->narrowed.empty());
                CHECK(contains(base::joined(none->lost), "the range of `drive` is "));
                CHECK(contains(base::joined(none->lost), "`follower` narrows it from "));
            }
        }
}

TEST_CASE("limits: those of springs are closed, and refused by the spring's name", "[limits]") {
    scene::Scene scene = scene_of({bar("mass", 0.1, Vector3(0.5, 0, 0))}, 0.01);
    scene::Spring rope = spring_between("rope", {"", Vector3::Zero(), z_axis}, {"mass", Vector3::Zero(), z_axis}, {});
    rope.forces.limits = {0.0, 0.5};
    scene.mechanism.springs = {rope};
    scene.gravity = Vector3(9.81, 0, 0);
    const Model model = built(scene);
    const auto out = run(model, 100);
    const Vector3 end = place(model, out, 100, 0, Vector3::Zero());
    CHECK(end.norm() > 0.5);
    CHECK(end.norm() < 0.5 + stop_give * model.dhat);
    scene.mechanism.springs[0].forces.limits = {0.0, 0.49};
    const auto refused = setup::build_model(scene);
    REQUIRE(!refused);
    CHECK(contains(refused.errors()[0].message, "`rope` is at 0.5 m, beyond its limits, 0 to 0.49 m"));
}

}  // namespace fettle::core::model::limits_test
