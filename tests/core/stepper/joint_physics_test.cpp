// SPDX-License-Identifier: MIT
// Joints, springs and motors against closed forms.
#include <numbers>

#include "core/kinematics/mass_matrix.hpp"
#include "core/model/limits.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::core::stepper::joint_physics_test {

using namespace fettle::tests::mechanisms;
using core::scene::Attachment;
using core::scene::Integrator;
using core::scene::JointKind;

namespace {

const Vector3 y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ(), x_axis = Vector3::UnitX();
constexpr double pi = std::numbers::pi;

SimulationOptions first_steps(int steps) {
    SimulationOptions options;
    options.steps = steps;
    return options;
}

// A bar on a hinge along y at the origin, turned down by pi/2 - `amplitude` from x.
scene::Scene pendulum(double length, double amplitude, double h) {
    scene::Scene scene = scene_of({bar("bar", length, Vector3::Zero(), Vector3(0, pi / 2 - amplitude, 0))}, h);
    scene.gravity = Vector3(0, 0, -gravity);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"bar", Vector3::Zero(), y_axis})};
    return scene;
}

// Time of the first passage through the vertical, by interpolation between steps.
double quarter_period(const scene::Scene& scene) {
    const model::Model model = built(scene);
    const Simulation out = run(model, static_cast<int>(0.6 / model.timestep));
    const double length = model.bodies[0].mesh.vertices.row(0).maxCoeff() + model.bodies[0].reference_point.x();
    const auto side = [&](int t) { return place(model, out, t, 0, Vector3(length, 0, 0)).x(); };
    int t = 0;
    while (side(t + 1) * side(0) > 0) ++t;
    // Cubic through four steps, by two secant steps on the polynomial.
    const std::array<double, 4> v{side(t - 1), side(t), side(t + 1), side(t + 2)};
    const auto cubic = [&](double s) {
        return v[0] * -s * (s - 1) * (s - 2) / 6 + v[1] * (s + 1) * (s - 1) * (s - 2) / 2 - v[2] * (s + 1) * s * (s - 2) / 2 +
               v[3] * (s + 1) * s * (s - 1) / 6;
    };
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
        const double mid = 0.5 * (low + high);
        (cubic(mid) * cubic(0) > 0 ? low : high) = mid;
    }
    return (t + low) * model.timestep;
}

// Crank, coupler, rocker of a planar four-bar in the plane z = 0, assembled at crank angle 0, ground pivots at 0 and (ground, 0).
struct FourBar {
    double crank = 0.1, coupler = 0.35, rocker = 0.25, ground = 0.3;
    // The joint between coupler and rocker: of both circles' intersections the upper one.
    Vector3 tip(double angle) const {
        const Vector3 a(crank * std::cos(angle), crank * std::sin(angle), 0), d(ground - a.x(), -a.y(), 0);
        const double span = d.norm(), along = (coupler * coupler - rocker * rocker + span * span) / (2 * span);
        const double up = std::sqrt(coupler * coupler - along * along);
        return a + along / span * d + up / span * Vector3(-d.y(), d.x(), 0);
    }
    scene::Scene scene(double h) const {
        const Vector3 a(crank, 0, 0), b = tip(0), o(ground, 0, 0);
        const auto towards = [](const Vector3& from, const Vector3& to) {
            return Vector3(0, 0, std::atan2(to.y() - from.y(), to.x() - from.x()));
        };
        scene::Scene out =
            scene_of({bar("crank", crank), bar("coupler", coupler, a, towards(a, b)), bar("rocker", rocker, o, towards(o, b))}, h);
        const auto end = [](double length) { return Vector3(length, 0, 0); };
        out.mechanism.joints = {joint("O", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
                                joint("A", JointKind::revolute, {"crank", end(crank), z_axis}, {"coupler", Vector3::Zero(), z_axis}),
                                joint("B", JointKind::revolute, {"coupler", end(coupler), z_axis}, {"rocker", end(rocker), z_axis}),
                                joint("C", JointKind::revolute, {"", o, z_axis}, {"rocker", Vector3::Zero(), z_axis})};
        return out;
    }
};

// Crank about the origin, connecting rod, slider along x.
struct SliderCrank {
    double crank = 0.1, rod = 0.3;
    double slide(double angle) const {
        return crank * std::cos(angle) + std::sqrt(rod * rod - crank * crank * std::sin(angle) * std::sin(angle));
    }
    double slope(double angle) const {
        const double s = crank * std::sin(angle);
        return -s - s * crank * std::cos(angle) / std::sqrt(rod * rod - s * s);
    }
    scene::Scene scene(double h) const {
        scene::Scene out =
            scene_of({bar("crank", crank), bar("rod", rod, Vector3(crank, 0, 0)), bar("slider", 0.05, Vector3(crank + rod, 0, 0))}, h);
        out.mechanism.joints = {
            joint("main", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
            joint("pin", JointKind::revolute, {"crank", Vector3(crank, 0, 0), z_axis}, {"rod", Vector3::Zero(), z_axis}),
            joint("wrist", JointKind::revolute, {"rod", Vector3(rod, 0, 0), z_axis}, {"slider", Vector3::Zero(), z_axis}),
            joint("guide", JointKind::prismatic, {"", Vector3(crank + rod, 0, 0), x_axis}, {"slider", Vector3::Zero(), x_axis})};
        return out;
    }
};

}  // namespace

TEST_CASE("a pendulum's period is that of its length and gravity", "[joints]") {
    constexpr double length = 0.5, amplitude = 0.2, half = 0.01;
    // A bar turns about its end: I = m (L^2/3 + (2 half)^2/12), lever L/2.
    const double arm = length / 2, ratio = (length * length / 3 + 4 * half * half / 12) / arm;
    const double k = std::sin(amplitude / 2), period = 4 * std::sqrt(ratio / gravity) * std::comp_ellint_1(k);
    std::vector<double> errors;
    for (const double h : {4e-3, 2e-3, 1e-3}) {
        scene::Scene scene = pendulum(length, amplitude, h);
        scene.integrator = Integrator::bdf2;
        errors.push_back(std::abs(4 * quarter_period(scene) - period) / period);
    }
    CAPTURE(errors[0], errors[1], errors[2]);
    CHECK(errors[2] < 1e-4);
    CHECK(std::log2(errors[1] / errors[2]) > 1.7);
}

TEST_CASE("a four-bar goes where trigonometry has it, a whole turn", "[joints]") {
    const FourBar bars;
    scene::Scene scene = bars.scene(0.01);
    scene.mechanism.motors = {motor("drive", "O", at_rate(2 * pi))};
    const model::Model model = built(scene);
    REQUIRE(model.mechanism.dependent.size() == 3);  // in a plane three of twenty rows follow from the rest, and one does of the motor's
    const Simulation out = run(model, 100);
    double worst = 0, worst_gap = 0;
    for (int t = 0; t <= 100; ++t)
        worst = std::max(worst, (place(model, out, t, 1, Vector3(bars.coupler, 0, 0)) - bars.tip(2 * pi * t / 100)).norm());
    for (const StepReport& step : out.report.steps) worst_gap = std::max(worst_gap, step.joint_gap);
    CAPTURE(worst, worst_gap, model.diagonal);
    CHECK(worst < 1e-9 * bars.ground);
    CHECK(worst_gap < 1e-9 * model.diagonal);
}

TEST_CASE("a slider-crank's stroke is trigonometry's, and its torque that of the load", "[joints]") {
    const SliderCrank crank;
    constexpr double load = 12;
    scene::Scene scene = crank.scene(0.01);
    scene.integrator = Integrator::quasi_static;
    scene.mechanism.motors = {motor("drive", "main", at_rate(2 * pi))};
    scene.mechanism.loads = {{"push", "", "slider", Vector3::Zero(), Vector3(-load, 0, 0)}};
    const model::Model model = built(scene);
    const Simulation out = run(model, 100);
    double worst = 0, worst_torque = 0;
    for (int t = 1; t <= 100; ++t) {
        const double angle = 2 * pi * t / 100;
        worst = std::max(worst, std::abs(place(model, out, t, 2, Vector3::Zero()).x() - crank.slide(angle)));
        const JointForce& drive = out.outputs[t - 1].joints.back();
        worst_torque = std::max(worst_torque, std::abs(drive.effort - load * crank.slope(angle)));
    }
    CAPTURE(worst, worst_torque);
    CHECK(worst < 1e-9 * crank.rod);
    CHECK(worst_torque < 1e-5 * load * crank.crank);  // the proximal term's share
}

TEST_CASE("gears turn by their numbers of teeth, a rack by its radius, a screw by its pitch, slides in their ratio", "[joints]") {
    scene::Scene scene = scene_of({bar("first", 0.1), bar("second", 0.1, Vector3(0.3, 0, 0)), bar("rack", 0.1, Vector3(0, 0.2, 0)),
                                   bar("screw", 0.1, Vector3(0, 0, 0.3)), bar("jaw", 0.1, Vector3(0, 0.4, 0))},
                                  0.01);
    scene.mechanism.joints = {joint("one", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"first", Vector3::Zero(), z_axis}),
                              joint("two", JointKind::revolute, {"", Vector3(0.3, 0, 0), z_axis}, {"second", Vector3::Zero(), z_axis}),
                              joint("slide", JointKind::prismatic, {"", Vector3(0, 0.2, 0), x_axis}, {"rack", Vector3::Zero(), x_axis}),
                              joint("thread", JointKind::screw, {"", Vector3(0, 0, 0.3), x_axis}, {"screw", Vector3::Zero(), x_axis})};
    scene.mechanism.joints.back().pitch = 0.02;
    scene.mechanism.joints.push_back(
        joint("other slide", JointKind::prismatic, {"", Vector3(0, 0.4, 0), z_axis}, {"jaw", Vector3::Zero(), z_axis}));
    for (const auto& [name, kind, first, second, ratio] :
         {std::tuple("gear", JointKind::gear, "one", "two", -20.0 / 41.0), std::tuple("pinion", JointKind::rack, "one", "slide", 0.03),
          std::tuple("belt", JointKind::gear, "two", "thread", 1.5), std::tuple("jaws", JointKind::gear, "slide", "other slide", -0.5)}) {
        scene::Joint coupling = joint(name, kind, {}, {});
        coupling.of = {first, second};
        coupling.ratio = ratio;
        scene.mechanism.joints.push_back(coupling);
    }
    scene.mechanism.motors = {motor("drive", "one", at_rate(20))};
    const model::Model model = built(scene);
    const Simulation out = run(model, 200);  // 40 rad: more than six turns
    const auto angle_of = [&](int body, const Vector3& axis) {
        const Vector3 v = kinematics::rotation_vector(out.trajectory.poses[200][body].rotation);
        return v.dot(axis);
    };
    const double second = -20.0 / 41.0 * 40;
    CHECK(std::abs(std::remainder(angle_of(0, z_axis) - 40, 2 * pi)) < 1e-9);
    CHECK(std::abs(std::remainder(angle_of(1, z_axis) - second, 2 * pi)) < 1e-9);
    CHECK(place(model, out, 200, 2, Vector3::Zero()).x() == Approx(0.03 * 40).epsilon(1e-9));
    CHECK(std::abs(std::remainder(angle_of(3, x_axis) - 1.5 * second, 2 * pi)) < 1e-9);
    CHECK(place(model, out, 200, 3, Vector3::Zero()).x() == Approx(0.02 * 1.5 * second / (2 * pi)).epsilon(1e-9));
    CHECK(place(model, out, 200, 4, Vector3::Zero()).z() == Approx(-0.5 * 0.03 * 40).epsilon(1e-9));
}

TEST_CASE("each hinge of a hanging chain carries what hangs below it", "[joints]") {
    constexpr int links = 12;
    constexpr double length = 0.1;
    std::vector<scene::Body> bodies;
    for (int k = 0; k < links; ++k)
        bodies.push_back(bar("link" + std::to_string(k), length, Vector3(0, 0, -k * length), Vector3(0, pi / 2, 0)));
    scene::Scene scene = scene_of(std::move(bodies), 0.01);
    scene.gravity = Vector3(0, 0, -gravity);
    for (int k = 0; k < links; ++k)
        scene.mechanism.joints.push_back(
            joint("hinge" + std::to_string(k), JointKind::revolute,
                  {k == 0 ? "" : "link" + std::to_string(k - 1), k == 0 ? Vector3(0, 0, 0) : Vector3(length, 0, 0), y_axis},
                  {"link" + std::to_string(k), Vector3::Zero(), y_axis}));
    const model::Model model = built(scene);
    const Simulation out = run(model, 5);
    const double weight = model.bodies[0].moments(3, 3) * gravity;
    for (const JointForce& f : out.outputs.back().joints) {
        CAPTURE(f.joint);
        CHECK((f.force - Vector3(0, 0, weight * (links - f.joint))).norm() < 1e-9 * weight);
        CHECK(f.torque.norm() < 1e-9 * weight * length);
    }
}

TEST_CASE("a double pendulum keeps its energy, the better the shorter the step", "[joints]") {
    std::vector<double> losses;
    for (const double h : {2e-3, 1e-3, 5e-4}) {
        scene::Scene scene = scene_of({bar("upper", 0.4), bar("lower", 0.3, Vector3(0.4, 0, 0))}, h);
        scene.gravity = Vector3(0, 0, -gravity);
        scene.integrator = Integrator::bdf2;
        scene.mechanism.joints = {
            joint("shoulder", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"upper", Vector3::Zero(), y_axis}),
            joint("elbow", JointKind::revolute, {"upper", Vector3(0.4, 0, 0), y_axis}, {"lower", Vector3::Zero(), y_axis})};
        const model::Model model = built(scene);
        const Simulation out = run(model, static_cast<int>(0.5 / h));
        const auto energy = [](const StepOutputs& o) { return o.kinetic_energy + o.potential_energy; };
        const double fallen = out.outputs.back().kinetic_energy;
        const double start = -gravity * 0;  // all at the height of the world's origin
        losses.push_back(std::abs(energy(out.outputs.back()) - start) / fallen);
    }
    CAPTURE(losses[0], losses[1], losses[2]);
    CHECK(losses[2] < 2e-3);
    CHECK(std::log2(losses[1] / losses[2]) > 1.7);
}

TEST_CASE("a mass on a spring has the period of its stiffness, and a damper takes its energy", "[joints]") {
    constexpr double stiffness = 20, stretch = 0.02;
    for (const double damping : {0.0, 0.3}) {
        std::vector<double> errors;
        for (const double h : {4e-3, 2e-3, 1e-3}) {
            scene::Scene scene = scene_of({bar("mass", 0.1)}, h);
            scene.integrator = Integrator::bdf2;
            scene.mechanism.joints = {
                joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"mass", Vector3::Zero(), x_axis})};
            scene.mechanism.joints[0].forces.stiffness = stiffness;
            scene.mechanism.joints[0].forces.rest = -stretch;
            scene.mechanism.joints[0].forces.damping = damping;
            const model::Model model = built(scene);
            const double mass = model.bodies[0].moments(3, 3), rate = damping / (2 * mass),
                         omega = std::sqrt(stiffness / mass - rate * rate);
            const int steps = static_cast<int>(std::round(0.4 / h));
            const Simulation out = run(model, steps);
            const double t = steps * h;
            const double exact = stretch * (std::exp(-rate * t) * (std::cos(omega * t) + rate / omega * std::sin(omega * t)) - 1);
            errors.push_back(std::abs(place(model, out, steps, 0, Vector3::Zero()).x() - exact) / stretch);
        }
        CAPTURE(damping, errors[0], errors[1], errors[2]);
        CHECK(errors[2] < 3e-3);
        CHECK(std::log2(errors[1] / errors[2]) > 1.7);
    }
}

TEST_CASE("a ball joint's swing ends the fall in any direction, and tells its torque", "[joints]") {
    for (const double turn : {0.0, 0.7, 2.5}) {
        // The bar begins upright-ish to one side and falls about the ball until its axis is 0.5 rad from the world's.
        scene::Scene scene = scene_of({bar("arm", 0.3, Vector3::Zero(), Vector3(0, 0, turn))}, 0.01);
        scene.integrator = Integrator::quasi_static;
        scene.gravity = Vector3(0, 0, -gravity);
        const Vector3 along(std::cos(turn), std::sin(turn), 0);
        scene.mechanism.joints = {joint("ball", JointKind::ball, {"", Vector3::Zero(), along}, {"arm", Vector3::Zero(), Vector3::UnitX()})};
        scene.mechanism.joints[0].swing = 0.5;
        const model::Model model = built(scene);
        REQUIRE(model.mechanism.terms.size() == 1);
        CHECK(is_swing(model.mechanism, model.mechanism.terms[0]));
        const Simulation out = run(model, 60);
        const Vector3 now = out.trajectory.poses.back()[0].rotation.col(0), centre = out.trajectory.poses.back()[0].position;
        const double swing = std::acos(now.dot(along)), give = model::stop_give * model.dhat / model.mechanism.terms[0].length;
        CHECK(swing > 0.499);
        CHECK(std::cos(swing) > std::cos(0.5) - give);
        CHECK(now.z() == Approx(-std::sin(swing)).margin(1e-3));
        // At rest it holds the weight's moment.
        const double moment = centre.head<2>().norm() * gravity * model.bodies[0].moments(3, 3);
        CHECK(std::abs(out.outputs.back().joints.at(0).stop) == Approx(moment).epsilon(0.02));
    }
}

TEST_CASE("a point-to-point spring pulls along its length, and stops hold at their limits", "[joints]") {
    scene::Scene scene = scene_of({bar("arm", 0.3)}, 0.01);
    scene.gravity = Vector3(0, 0, -gravity);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"arm", Vector3::Zero(), y_axis})};
    SECTION("a spring holds the arm") {
        // From (0, 0, 0.4) to the arm's end: at rest its moment about the hinge is that of the weight.
        scene.integrator = Integrator::quasi_static;
        scene::Spring spring;
        spring.name = "spring";
        spring.a = {"", Vector3(0, 0, 0.4), z_axis};
        spring.b = {"arm", Vector3(0.3, 0, 0), z_axis};
        spring.forces.stiffness = 300;
        spring.forces.rest = 0.4;
        scene.mechanism.springs = {spring};
        const model::Model model = built(scene);
        const Simulation out = run(model, 30);
        const Vector3 end = place(model, out, 30, 0, Vector3(0.3, 0, 0)), top(0, 0, 0.4), centre = out.trajectory.poses[30][0].position;
        const double length = (end - top).norm(), pull = 300 * (length - 0.4);
        const Vector3 moment =
            end.cross(pull * (top - end) / length) + centre.cross(Vector3(0, 0, -gravity * model.bodies[0].moments(3, 3)));
        CHECK(moment.norm() < 1e-6);
        CHECK(out.outputs.back().measure_forces.at(0) == Approx(-pull).epsilon(1e-12));
        CHECK(out.outputs.back().spring_energy == Approx(0.5 * 300 * (length - 0.4) * (length - 0.4)));
    }
    SECTION("a stop ends the fall") {
        scene.mechanism.joints[0].forces.limits = {-0.1, 0.5};  // turns about y by positive angles are downwards
        const model::Model model = built(scene);
        const Simulation out = run(model, 200);
        double most = 0;
        for (const auto& poses : out.trajectory.poses) most = std::max(most, kinematics::rotation_vector(poses[0].rotation).y());
        CHECK(most > 0.5);  // a stop gives way a little where it is pressed
        CHECK(most < 0.5 + model::stop_give * model.dhat / model.mechanism.terms[0].length);
        CHECK(kinematics::rotation_vector(out.trajectory.poses.back()[0].rotation).y() == Approx(0.5).margin(0.01));
    }
}

// The forces of spring and stop cancel: what is left of them is rounding, against which nothing may be measured.
TEST_CASE("a spring presses a light slide on its stop: statics find it, with and without gradient", "[joints]") {
    const double preload = GENERATE(0.5, 3.0, 11.3, 40.0), half = GENERATE(0.001, 0.002, 0.01), exactly = GENERATE(0, 1);
    CAPTURE(preload, half, exactly);
    scene::Scene scene = scene_of({bar("plunger", 0.01, Vector3::Zero(), Vector3::Zero(), half)}, 0.01);
    scene.velocity_tolerance.reset();
    scene.integrator = Integrator::quasi_static;
    scene.mechanism.joints = {joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"plunger", Vector3::Zero(), x_axis})};
    scene.mechanism.joints[0].forces = {1000, std::nullopt, preload, 0, 0, std::array<double, 2>{-3e-5, 8e-3}};
    const model::Model model = built(scene);
    const Simulation out = run(model, 3, exactly > 0);
    const double x = out.trajectory.poses[3][0].position.x() - out.trajectory.poses[0][0].position.x(),
                 width = model::stop_give * model.dhat, gap = x + 3e-5 + width;
    CHECK(gap > 0);
    CHECK(gap < width);
    CHECK(gap > 0.1 * width);  // the stop is as stiff as the spring is strong
    const double push = model.kappa / model::stop_give * (gap - width) * (-2 * std::log(gap / width) + width / gap - 1);
    CHECK(push == Approx(-(1000 * x + preload)).epsilon(1e-4));
}

TEST_CASE("friction of a joint holds below its torque and brakes above it", "[joints]") {
    scene::Scene scene = scene_of({bar("disc", 0.2)}, 0.005);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3(0.1, 0, 0), z_axis}, {"disc", Vector3(0.1, 0, 0), z_axis})};
    scene.mechanism.joints[0].forces.friction = 0.02;
    scene.friction.eps_v = 1e-6;
    scene::Motor push = motor("push", "hinge", {});
    push.kind = scene::MotorKind::effort;
    push.curve.times = {0};
    for (const double torque : {0.015, 0.021}) {
        push.curve.values = {torque};
        scene.mechanism.motors = {push};
        const model::Model model = built(scene);
        const Simulation out = run(model, 40);
        const double inertia = kinematics::mass_matrix(Matrix3::Identity(), model.bodies[0].moments)(5, 5), time = 40 * 0.005;
        const double angle = kinematics::rotation_vector(out.trajectory.poses.back()[0].rotation).z();
        CAPTURE(torque, angle);
        // Implicit Euler: sum of k h^2 alpha.
        if (torque < 0.02)
            CHECK(std::abs(angle) < 1e-5);
        else
            CHECK(angle == Approx((torque - 0.02) / inertia * 0.5 * time * (time + 0.005)).epsilon(1e-3));
    }
}

TEST_CASE("a joint slides as soon as the force is more than its friction, with the default accuracy", "[joints]") {
    for (const double excess : {0.002, 0.006, 0.02})
        for (const double h : {0.01, 0.002}) {
            scene::Scene scene = scene_of({bar("mass", 0.2)}, h);
            scene.velocity_tolerance.reset();
            scene.mechanism.joints = {
                joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"mass", Vector3::Zero(), x_axis})};
            scene.mechanism.joints[0].forces.friction = 5;
            scene.bodies[0].force = Vector3(5 * (1 + excess), 0, 0);
            const model::Model model = built(scene);
            constexpr double time = 1;
            const Simulation out = run(model, static_cast<int>(time / h));
            const double mass = model.bodies[0].moments(3, 3), way = 0.5 * 5 * excess / mass * time * time;
            const double moved =
                place(model, out, static_cast<int>(time / h), 0, Vector3::Zero()).x() - place(model, out, 0, 0, Vector3::Zero()).x();
            INFO("excess " << excess << ", time step " << h << ": " << moved << " m of " << way);
            CHECK(moved > 0.95 * way);  // below eps_v, 1 mm/s, it takes a moment longer
            CHECK(moved < 1.03 * way + 1e-3 * time);
        }
}

TEST_CASE("what a gear transmits is told: the torque that turns its second wheel", "[joints]") {
    scene::Scene scene = scene_of({bar("one", 0.1), bar("two", 0.1, Vector3(0.3, 0, 0))}, 1e-3);
    scene.mechanism.joints = {joint("a", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"one", Vector3::Zero(), z_axis}),
                              joint("b", JointKind::revolute, {"", Vector3(0.3, 0, 0), z_axis}, {"two", Vector3::Zero(), z_axis})};
    scene::Joint gear = joint("g", JointKind::gear, {}, {});
    gear.of = {"a", "b"};
    gear.ratio = -0.4;
    scene.mechanism.joints.push_back(gear);
    scene.bodies[0].torque = Vector3(0, 0, 0.001);
    const model::Model model = built(scene);
    const Simulation out = run(model, 50);
    const auto inertia = [&](int body) {  // about its hinge, along z
        const Matrix4& m = model.bodies[body].moments;
        const Vector3 c = model.bodies[body].reference_point;
        return m(0, 0) + m(1, 1) + 2 * c.head<2>().dot(m.topRightCorner<2, 1>()) + c.head<2>().squaredNorm() * m(3, 3);
    };
    // torque + ratio effort' = I1 a1,  -effort' = I2 a2 with a2 = ratio a1: the second wheel gets I2 ratio torque/(I1 + ratio^2 I2).
    const double effort = inertia(1) * gear.ratio * 0.001 / (inertia(0) + gear.ratio * gear.ratio * inertia(1));
    CHECK(out.outputs.back().joints[2].effort == Approx(effort).epsilon(1e-3));
}

TEST_CASE("a motor that contact stops is blocked: joint, torque and what is in the way are named", "[joints]") {
    // The bar comes round against a post after a quarter turn.
    scene::Scene scene = scene_of({bar("arm", 0.3), bar("post", 0.05, Vector3(-0.025, 0.2, 0))}, 0.01);
    for (scene::Body& body : scene.bodies) body.group = -1;
    scene.bodies[1].type = scene::BodyType::static_body;
    scene.dhat = 1e-3;
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"arm", Vector3::Zero(), z_axis})};
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(2 * pi))};
    const Simulation out = simulate(built(scene), first_steps(60));
    CHECK(out.report.status == SimulationStatus::blocked);
    const std::string& message = out.report.message;
    CAPTURE(message);
    CHECK(tests::support::contains(message, "motor 'drive' cannot follow its curve"));
    CHECK(tests::support::contains(message, "N m"));
    CHECK(tests::support::contains(message, "'arm'"));
    CHECK(tests::support::contains(message, "'post'"));
    CHECK(out.report.steps.size() > 15);
    CHECK(out.report.steps.size() < 25);
}

TEST_CASE("a motor that a stop blocks names the stop", "[joints]") {
    // The arm is turned up against gravity, to a stop at half a radian.
    scene::Scene scene = scene_of({bar("arm", 0.3)}, 0.01);
    scene.gravity = Vector3(0, -gravity, 0);
    scene.mechanism.joints = {joint("hinge", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"arm", Vector3::Zero(), z_axis})};
    scene.mechanism.joints[0].forces.limits = {-1.0, 0.5};
    scene.mechanism.motors = {motor("drive", "hinge", at_rate(1))};
    const Simulation out = simulate(built(scene), first_steps(60));
    CHECK(out.report.status == SimulationStatus::blocked);
    const std::string& message = out.report.message;
    CAPTURE(message);
    CHECK(tests::support::contains(message, "motor 'drive' cannot follow its curve"));
    CHECK(tests::support::contains(message, "'hinge' is at its upper limit"));
    CHECK(out.report.steps.size() >= 48);
    CHECK(out.report.steps.size() <= 50);
}

TEST_CASE("turns are counted in a run that is taken up again as in one", "[joints]") {
    scene::Scene scene = scene_of({bar("first", 0.1), bar("second", 0.1, Vector3(0.3, 0, 0))}, 0.01);
    scene.mechanism.joints = {joint("one", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"first", Vector3::Zero(), z_axis}),
                              joint("two", JointKind::revolute, {"", Vector3(0.3, 0, 0), z_axis}, {"second", Vector3::Zero(), z_axis})};
    scene::Joint gear = joint("gear", JointKind::gear, {}, {});
    gear.of = {"one", "two"};
    gear.ratio = 0.37;
    scene.mechanism.joints.push_back(gear);
    scene.mechanism.motors = {motor("drive", "one", at_rate(30))};
    const model::Model model = built(scene);
    const Simulation whole = simulate(model, first_steps(100)), part = simulate(model, first_steps(70));
    SimulationOptions options;
    options.steps = 100;
    options.resume = &part;
    const Simulation joined = simulate(model, options);
    REQUIRE(joined.trajectory.poses.size() == 101);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(joined.trajectory.poses[100][i].rotation == whole.trajectory.poses[100][i].rotation);
        CHECK(joined.trajectory.poses[100][i].position == whole.trajectory.poses[100][i].position);
    }
}

}  // namespace fettle::core::stepper::joint_physics_test
