// SPDX-License-Identifier: MIT
// How far a stored path is from where joints and motors have the bodies: against trigonometry, at many instants between the nodes.
#include "fettle/core/certificate/joint_prover.hpp"

#include "fettle/core/clearance/jointed_clearance.hpp"
#include "fettle/tests/core/clearance/four_bar_motion.hpp"

namespace fettle::core::certificate::joint_prover_test {

using namespace fettle::tests::four_bar;
using fettle::tests::mechanisms::at_rate;
using fettle::tests::mechanisms::built;
using fettle::tests::support::contains;

namespace {

struct Driven {
    model::Model model;
    scene::Curve curve;
    stepper::JointedMotion motion;
    IdealJoints joints;
};

Driven driven(const scene::Curve& curve, int steps) {
    Driven out{built(four_bar_scene(curve, 1.0 / steps)), curve, {}, {}};
    auto motion = stepper::follow_joints(out.model, steps, 1);  // no finer than asked for
    REQUIRE(motion);
    out.motion = std::move(motion).value();
    REQUIRE(out.motion.parts == 1);
    auto joints = clearance::ideal_joints(out.model, out.motion.held);
    REQUIRE(joints);
    out.joints = std::move(joints).value();
    out.joints.deviations.assign(out.joints.bodies.size(), 0.0);
    REQUIRE(check_joints(out.joints, out.model.bodies.size()).empty());
    return out;
}

// The farthest that a vertex of the body is seen from where trigonometry has it.
double seen(const Driven& d, int body, int instants) {
    const stepper::Trajectory& trajectory = d.motion.trajectory;
    double most = 0;
    for (int t = 0; t < static_cast<int>(trajectory.steps.size()); ++t)
        for (int i = 0; i <= instants; ++i) {
            const double s = static_cast<double>(i) / instants;
            const double angle = curve_value(d.curve, time_at(trajectory, t, 0, s)) - curve_value(d.curve, 0);
            const kinematics::Pose pose = pose_at(trajectory, t, 0, s, body);
            const auto& vertices = d.model.bodies[static_cast<std::size_t>(body)].mesh.vertices;
            for (Eigen::Index v = 0; v < vertices.cols(); ++v)
                most = std::max(most, (world_position(pose, vertices.col(v)) - vertex_at(d.model, body, v, angle)).norm());
        }
    return most;
}

}  // namespace

TEST_CASE("joint prover: a four-bar is nowhere farther from its path than proven, and not much less", "[mechanism][certificate]") {
    double before = 0;
    for (const int steps : {40, 160}) {
        const Driven d = driven(at_rate(2 * M_PI), steps);
        const ProvenDeviations proven = prove_deviations(d.joints, d.model, d.motion.trajectory);
        INFO(proven.fault);
        REQUIRE(proven.of_body.size() == 3);
        for (int body = 0; body < 3; ++body) {
            const double farthest = seen(d, body, 16), bound = proven.of_body[static_cast<std::size_t>(body)];
            CAPTURE(steps, body, farthest, bound);
            CHECK(farthest > 1e-7);
            CHECK(farthest <= bound);
            CHECK(bound < 6 * farthest);
        }
        if (before > 0) CHECK(proven.of_body[1] < before / 12);  // of second order
        before = proven.of_body[1];
    }
}

TEST_CASE("joint prover: what motors' curves do between nodes counts", "[mechanism][certificate]") {
    // Knots lie between the nodes of 200 steps.
    const std::vector<double> times{0, 0.153, 0.407, 0.731, 0.951}, values{0, 0.6, -0.2, 0.9, 0.4};
    for (const scene::CurveKind kind : {scene::CurveKind::linear, scene::CurveKind::cubic, scene::CurveKind::trapezoid}) {
        scene::Curve curve{kind, 0.1, times, values, 0.901};
        const Driven d = driven(curve, 200);
        const ProvenDeviations proven = prove_deviations(d.joints, d.model, d.motion.trajectory);
        INFO(proven.fault);
        REQUIRE(proven.of_body.size() == 3);
        for (int body = 0; body < 3; ++body) {
            const double farthest = seen(d, body, 40), bound = proven.of_body[static_cast<std::size_t>(body)];
            CAPTURE(static_cast<int>(kind), body, farthest, bound);
            CHECK(farthest <= bound);
            CHECK(bound < 30 * farthest);
        }
    }
    const scene::Curve spline{scene::CurveKind::control_points, 0, {0, 1}, {0, 0.3, -0.4, 1.2, 0.5, 0.2}, std::nullopt};
    const Driven d = driven(spline, 50);
    const ProvenDeviations proven = prove_deviations(d.joints, d.model, d.motion.trajectory);
    REQUIRE(proven.of_body.size() == 3);
    for (int body = 0; body < 3; ++body) CHECK(seen(d, body, 40) <= proven.of_body[static_cast<std::size_t>(body)]);
}

TEST_CASE("joint prover: what does not determine the bodies, or is not where they are, proves nothing", "[mechanism][certificate]") {
    const Driven d = driven(at_rate(2 * M_PI), 40);
    const auto proven = [&](const IdealJoints& joints) { return prove_deviations(joints, d.model, d.motion.trajectory); };
    const double bound = proven(d.joints).of_body.at(1);
    IdealJoints twice = d.joints;
    twice.rows[1] = twice.rows[0];
    CHECK(contains(proven(twice).fault, "step 1"));
    IdealJoints elsewhere = d.joints;
    elsewhere.rows[0].constant += 1e-3;
    const ProvenDeviations moved = proven(elsewhere);
    if (moved.fault.empty()) CHECK(moved.of_body.at(0) > 9e-4);
    IdealJoints faster = d.joints;  // the motor's row, the only one with a curve
    for (constraint::Row& row : faster.rows)
        if (row.curve.rate != 0) row.curve.rate *= 1.01;
    const ProvenDeviations ahead = proven(faster);
    if (ahead.fault.empty()) CHECK(ahead.of_body.at(1) > 2 * bound);
    IdealJoints longer = d.joints;  // a rod of another length
    for (measure::Frame& frame : longer.set.frames)
        if (frame.body == coupler_body && frame.point.x() > 0) frame.point.x() += 1e-3;
    const ProvenDeviations other = proven(longer);
    if (other.fault.empty()) CHECK(other.of_body.at(1) > 5e-4);
}

TEST_CASE("joints as data: faults by place", "[mechanism][certificate]") {
    const Driven d = driven(at_rate(2 * M_PI), 40);
    const auto faults = [&](const auto& change) {
        IdealJoints joints = d.joints;
        change(joints);
        const base::Errors errors = check_joints(joints, d.model.bodies.size());
        return errors.empty() ? std::string() : errors.front().where;
    };
    CHECK(faults([](IdealJoints&) {}).empty());
    CHECK(faults([](IdealJoints& j) { j.set.frames[2].body = 9; }) == "/joints/frames/2");
    CHECK(faults([](IdealJoints& j) { j.set.measures[1].b = 99; }) == "/joints/measures/1");
    CHECK(faults([](IdealJoints& j) { j.rows[3].parts[0].measure = -1; }) == "/joints/rows/3");
    CHECK(faults([](IdealJoints& j) { j.rows[3].curve.times = {1, 0}; }) == "/joints/rows/3");
    CHECK(faults([](IdealJoints& j) { j.rows.pop_back(); }) == "/joints/rows");
    CHECK(faults([](IdealJoints& j) { j.bodies[1] = 0; }) == "/joints/bodies/1");
    CHECK(faults([](IdealJoints& j) { j.deviations[0] = -1; }) == "/joints/deviations");
    CHECK(faults([](IdealJoints& j) { j.deviations.clear(); }) == "/joints/deviations");
}

}  // namespace fettle::core::certificate::joint_prover_test
