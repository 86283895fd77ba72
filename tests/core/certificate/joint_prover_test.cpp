// SPDX-License-Identifier: MIT
// How far a stored path is from where joints and motors have the bodies: against trigonometry, at many instants between the nodes.
#include "core/certificate/joint_prover.hpp"

#include <random>

#include "core/clearance/jointed_clearance.hpp"
#include "core/constraint/assembly.hpp"
#include "tests/core/clearance/four_bar_motion.hpp"

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
    for (int t = 0; t < count_of(trajectory.steps); ++t)
        for (int i = 0; i <= instants; ++i) {
            const double s = static_cast<double>(i) / instants;
            const double angle = curve_value(d.curve, time_at(trajectory, t, 0, s)) - curve_value(d.curve, 0);
            const kinematics::Pose pose = pose_at(trajectory, t, 0, s, body);
            const auto& vertices = d.model.bodies[body].mesh.vertices;
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
            const double farthest = seen(d, body, 16), bound = proven.of_body[body];
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
            const double farthest = seen(d, body, 40), bound = proven.of_body[body];
            CAPTURE(static_cast<int>(kind), body, farthest, bound);
            CHECK(farthest <= bound);
            CHECK(bound < 30 * farthest);
        }
    }
    const scene::Curve spline{scene::CurveKind::control_points, 0, {0, 1}, {0, 0.3, -0.4, 1.2, 0.5, 0.2}, std::nullopt};
    const Driven d = driven(spline, 50);
    const ProvenDeviations proven = prove_deviations(d.joints, d.model, d.motion.trajectory);
    REQUIRE(proven.of_body.size() == 3);
    for (int body = 0; body < 3; ++body) CHECK(seen(d, body, 40) <= proven.of_body[body]);
}

namespace {

using core::scene::JointKind;
using fettle::tests::mechanisms::bar;
using fettle::tests::mechanisms::joint;

const Vector3 x_axis = Vector3::UnitX(), z_axis = Vector3::UnitZ(), origin = Vector3::Zero();

// Whole scenes turned: no axis is one of the world's.
scene::Scene tilted(scene::Scene scene) {
    const Matrix3 turn = kinematics::rotation(Vector3(0.7, -0.4, 0.3));
    for (scene::Body& body : scene.bodies) {
        body.pose.rotation = turn * body.pose.rotation;
        body.pose.position = turn * body.pose.position;
    }
    for (scene::Joint& each : scene.mechanism.joints)
        for (scene::Attachment* end : {&each.a, &each.b})
            if (end->body.empty()) {
                end->point = turn * end->point;
                end->axis = turn * end->axis;
            }
    return scene;
}

// A crank, and a rocker along which the crank's pin slides in a die; a wheel geared to the crank; a piston on a rod of its own.
scene::Scene quick_return(double h) {
    constexpr double crank_length = 0.06, post = 0.15;
    const double angle = std::atan2(0.0, crank_length + post);
    scene::Scene out = fettle::tests::mechanisms::scene_of(
        {bar("crank", crank_length), bar("die", 0.02, Vector3(crank_length, 0, 0), Vector3(0, 0, angle)),
         bar("rocker", 0.3, Vector3(-post, 0, 0), Vector3(0, 0, angle)), bar("wheel", 0.05, Vector3(0, -0.3, 0))},
        h);
    out.mechanism.joints = {joint("main", JointKind::revolute, {"", origin, z_axis}, {"crank", origin, z_axis}),
                            joint("pin", JointKind::revolute, {"crank", Vector3(crank_length, 0, 0), z_axis}, {"die", origin, z_axis}),
                            joint("slot", JointKind::prismatic, {"rocker", origin, x_axis}, {"die", origin, x_axis}),
                            joint("pivot", JointKind::revolute, {"", Vector3(-post, 0, 0), z_axis}, {"rocker", origin, z_axis}),
                            joint("axle", JointKind::revolute, {"", Vector3(0, -0.3, 0), z_axis}, {"wheel", Vector3(0.01, 0, 0), z_axis})};
    out.bodies[3].pose.position = Vector3(-0.01, -0.3, 0);
    scene::Joint gear = joint("gear", JointKind::gear, {}, {});
    gear.of = {"main", "axle"};
    gear.ratio = -0.7;
    out.mechanism.joints.push_back(gear);
    out.mechanism.motors = {fettle::tests::mechanisms::motor("drive", "main", at_rate(2.5))};
    return out;
}

// A bolt in a thread, and a piston on a rod that a crank on the bolt's far side moves: two mechanisms in one scene.
scene::Scene bolt_and_piston(double h) {
    constexpr double crank_length = 0.05, rod = 0.12;
    scene::Scene out = fettle::tests::mechanisms::scene_of(
        {bar("bolt", 0.05), bar("crank", crank_length, Vector3(0, 0.3, 0)), bar("rod", rod, Vector3(crank_length, 0.3, 0)),
         bar("piston", 0.05, Vector3(crank_length + rod, 0.3, 0))},
        h);
    out.mechanism.joints = {joint("thread", JointKind::screw, {"", Vector3(0.01, 0, 0), z_axis}, {"bolt", Vector3(0.01, 0, 0), z_axis}),
                            joint("main", JointKind::revolute, {"", Vector3(0, 0.3, 0), z_axis}, {"crank", origin, z_axis}),
                            joint("big", JointKind::revolute, {"crank", Vector3(crank_length, 0, 0), z_axis}, {"rod", origin, z_axis}),
                            joint("small", JointKind::revolute, {"rod", Vector3(rod, 0, 0), z_axis}, {"piston", origin, z_axis}),
                            joint("guide", JointKind::prismatic, {"", Vector3(0, 0.3, 0), x_axis}, {"piston", origin, x_axis})};
    out.mechanism.joints[0].pitch = 0.01;
    out.mechanism.motors = {fettle::tests::mechanisms::motor("screw", "thread", at_rate(2)),
                            fettle::tests::mechanisms::motor("drive", "main", at_rate(2.5))};
    return out;
}

// Where Newton's method puts the bodies on the rows from the path on, in doubles. Contract: no angle leaves (-pi, pi).
std::vector<kinematics::Pose> met_at(const model::Model& model, const stepper::Trajectory& trajectory, int t, double s) {
    constraint::AssemblyProblem problem{model.mechanism.set, model.mechanism.rows, {}, {}, {}, model.diagonal};
    std::vector<kinematics::Pose> poses;
    for (int i = 0; i < count_of(model.bodies); ++i) {
        problem.moments.push_back(model.bodies[i].moments);
        problem.dofs.add_body([](int) { return true; });
        poses.push_back(pose_at(trajectory, t, 0, s, i));
    }
    problem.targets.resize(model.mechanism.rows.size());
    for (std::size_t r = 0; r < model.mechanism.rows.size(); ++r)
        problem.targets[r] = target_at(model.mechanism.rows[r], time_at(trajectory, t, 0, s));
    const constraint::Assembly found = assemble(problem, poses);
    REQUIRE(found.is_met);
    return found.poses;
}

// The farthest of each body's vertices, at some instants of every step.
std::vector<double> farthest_from_met(const model::Model& model, const stepper::Trajectory& trajectory) {
    std::vector<double> farthest(model.bodies.size(), 0.0);
    for (int t = 0; t < count_of(trajectory.steps); ++t)
        for (const double s : {0.0, 0.2, 0.5, 0.7, 1.0}) {
            const std::vector<kinematics::Pose> met = met_at(model, trajectory, t, s);
            for (std::size_t i = 0; i < met.size(); ++i) {
                const kinematics::Pose stored = pose_at(trajectory, t, 0, s, static_cast<int>(i));
                for (const auto& x : model.bodies[i].mesh.vertices.colwise())
                    farthest[i] = std::max(farthest[i], (world_position(stored, x) - world_position(met[i], x)).norm());
            }
        }
    return farthest;
}

// A four-bar of any lengths, started anywhere, turned anyhow; one in three nearly folds. The crank goes through 2 rad.
std::optional<scene::Scene> random_four_bar(std::mt19937& random, double h) {
    const auto u = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    const double ground_length = u(0.1, 0.3), coupler_length = u(0.1, 0.3), rocker_length = u(0.1, 0.3), start = u(-3, 3);
    const double room = coupler_length + rocker_length - ground_length;
    const double crank_length = random() % 3 == 0 ? room * (1 - u(1e-3, 1e-2)) : room * u(0.1, 0.9);
    if (!(crank_length > 0.02 && crank_length < 0.5)) return std::nullopt;
    const Vector3 b = crank_length * Vector3(std::cos(start), std::sin(start), 0), g(ground_length, 0, 0);
    const double distance = (g - b).norm();
    if (!(distance < 0.999 * (coupler_length + rocker_length) && distance > 1.001 * std::abs(coupler_length - rocker_length)))
        return std::nullopt;
    const double along = std::acos((coupler_length * coupler_length + distance * distance - rocker_length * rocker_length) /
                                   (2 * coupler_length * distance));
    const double angle = std::atan2(g.y() - b.y(), g.x() - b.x()) + along;
    const Vector3 end = b + coupler_length * Vector3(std::cos(angle), std::sin(angle), 0);
    scene::Scene out = fettle::tests::mechanisms::scene_of(
        {bar("crank", crank_length, origin, Vector3(0, 0, start)), bar("coupler", coupler_length, b, Vector3(0, 0, angle)),
         bar("rocker", rocker_length, g, Vector3(0, 0, std::atan2(end.y(), end.x() - ground_length)))},
        h);
    out.mechanism.joints = {joint("main", JointKind::revolute, {"", origin, z_axis}, {"crank", origin, z_axis}),
                            joint("pin", JointKind::revolute, {"crank", Vector3(crank_length, 0, 0), z_axis}, {"coupler", origin, z_axis}),
                            joint("end", JointKind::revolute, {"coupler", Vector3(coupler_length, 0, 0), z_axis},
                                  {"rocker", Vector3(rocker_length, 0, 0), z_axis}),
                            joint("pivot", JointKind::revolute, {"", g, z_axis}, {"rocker", origin, z_axis})};
    out.mechanism.motors = {fettle::tests::mechanisms::motor("drive", "main", at_rate(u(-2, 2)))};
    return tilted(std::move(out));
}

void look_at_random_four_bars(unsigned seed, int wanted, int least_proven) {
    std::mt19937 random(seed);
    int looked = 0, proven = 0;
    while (looked < wanted) {
        const int steps = 10 + static_cast<int>(random() % 60);
        const auto written = random_four_bar(random, 1.0 / steps);
        if (!written) continue;
        const model::Model model = built(*written);
        const auto motion = stepper::follow_joints(model, steps, 1);
        if (!motion) continue;  // it cannot go so far
        ++looked;
        const clearance::JointedPath path = clearance::jointed_path(model, *motion);
        CHECK(path.refusal.empty() == path.joints.has_value());
        if (!path.joints) continue;
        ++proven;
        const std::vector<double> farthest = farthest_from_met(model, motion->trajectory);
        for (std::size_t i = 0; i < farthest.size(); ++i) {
            CAPTURE(seed, looked, steps, motion->parts, i, farthest[i], path.joints->deviations[i]);
            CHECK(farthest[i] <= path.joints->deviations[i]);
        }
    }
    CAPTURE(looked, proven);
    CHECK(proven >= least_proven);
    if (looked >= 100) WARN(proven << " of " << looked << " are proven");
}

}  // namespace

TEST_CASE("joint prover: random four-bars, some of which nearly fold", "[mechanism][certificate]") { look_at_random_four_bars(3, 12, 6); }

TEST_CASE("joint prover: 400 random four-bars", "[mechanism][certificate][slow]") { look_at_random_four_bars(4, 400, 200); }

TEST_CASE("joint prover: sliding dies, gears, threads and pistons against assembled places", "[mechanism][certificate]") {
    for (const auto& written : {quick_return(0.02), bolt_and_piston(0.02)}) {
        const model::Model model = built(tilted(written));
        const auto motion = stepper::follow_joints(model, 50, 1);
        REQUIRE(motion);
        REQUIRE(motion->parts == 1);
        const clearance::JointedPath path = clearance::jointed_path(model, *motion);
        INFO(path.refusal);
        REQUIRE(path.joints);
        REQUIRE(path.joints->bodies.size() == model.bodies.size());
        const std::vector<double> farthest = farthest_from_met(model, motion->trajectory);
        for (std::size_t i = 0; i < farthest.size(); ++i) {
            CAPTURE(model.bodies[i].name, farthest[i], path.joints->deviations[i]);
            CHECK(farthest[i] > 1e-6);
            CHECK(farthest[i] <= path.joints->deviations[i]);
            CHECK(path.joints->deviations[i] < 8 * farthest[i]);
        }
    }
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
