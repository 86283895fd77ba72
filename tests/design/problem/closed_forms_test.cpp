// SPDX-License-Identifier: MIT
// Derivatives of mechanisms that have closed forms: oscillators (of the steps as they are made, exactly), crank torque, gears, a hanging
// chain, what slides and stops by friction.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/contact/barrier.hpp"
#include "design/problem/design_problem.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/joint_load.hpp"
#include "tests/design/linear_numbers.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::design::problem::closed_forms_test {

namespace {

using fettle::tests::design_support::follow;

using namespace fettle::tests::mechanisms;
using namespace fettle::design::description;
using core::scene::JointKind;

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

// A point of a body's file frame along a direction, at the end.
class EndPosition : public Quantity {
public:
    EndPosition(int body, const Vector3& point, const Vector3& along) : body_(static_cast<size_t>(body)), point_(point), along_(along) {}
    Dimension dimension() const override { return Dimension::length; }
    Measurement value(const Simulated& s) const override {
        return computed(along_.dot(core::kinematics::world_position(s.trajectory.poses.back()[body_], arm(s))));
    }
    void add_seeds(const Simulated& s, const Measurement&, double scale, Seeds& seeds) const override {
        seeds.trajectory_bar.pose_bar.back()[body_] += scale * along_ * arm(s).homogeneous().transpose();
    }

private:
    Vector3 arm(const Simulated& s) const { return point_ - s.model.bodies[body_].reference_point; }
    size_t body_;
    Vector3 point_, along_;
};

// Where the first body's reference point comes down to z = 0: on along the parabola through the last two steps.
class Landing : public Quantity {
public:
    Dimension dimension() const override { return Dimension::length; }
    Measurement value(const Simulated& s) const override { return computed(fall(s).range); }
    void add_seeds(const Simulated& s, const Measurement&, double scale, Seeds& seeds) const override {
        const Fall f = fall(s);
        const double h = s.model.timestep, steep = -s.model.gravity.z() * f.time - f.up;  // dtime = (dz + time dup)/steep
        const double by_z = f.forwards / steep, by_up = by_z * f.time;
        auto& bar = seeds.trajectory_bar.pose_bar;
        const size_t last = bar.size() - 1;
        bar[last][0](0, 3) += scale * (1 + f.time / h);
        bar[last - 1][0](0, 3) -= scale * f.time / h;
        bar[last][0](2, 3) += scale * (by_z + by_up / h);
        bar[last - 1][0](2, 3) -= scale * by_up / h;
    }

private:
    struct Fall {
        double forwards = 0, up = 0, time = 0, range = 0;
    };
    static Fall fall(const Simulated& s) {
        const double h = s.model.timestep, g = -s.model.gravity.z();
        const auto& poses = s.trajectory.poses;
        const Vector3 end = poses.back()[0].position, moved = end - poses[poses.size() - 2][0].position;
        Fall f;
        f.forwards = moved.x() / h;
        f.up = moved.z() / h - 0.5 * g * h;
        f.time = (f.up + std::sqrt(f.up * f.up + 2 * g * end.z())) / g;
        f.range = end.x() + f.forwards * f.time;
        return f;
    }
};

// A parameter that is the number at a place.
struct Moved {
    std::string name;
    double value = 0;
    std::string place;
};

void add_parameter(Design& design, const Moved& moved) {
    Parameter p;
    p.name = moved.name;
    p.value = moved.value;
    p.lower = p.value - 10 * std::abs(p.value);
    p.upper = p.value + 10 * std::abs(p.value);
    design.parameters.push_back(p);
    follow(design, moved.name, moved.place);
}
void add_parameters(Design& design, const std::vector<Moved>& all) {
    for (const Moved& moved : all) add_parameter(design, moved);
}

DesignEvaluation evaluated(Design design, const std::vector<std::shared_ptr<const Quantity>>& quantities) {
    for (size_t k = 0; k < quantities.size(); ++k) design.constraints.push_back({std::to_string(k), {}, quantities[k]});
    const auto problem = DesignProblem::create(std::move(design));
    if (!problem) UNSCOPED_INFO(problem.errors()[0].message);
    REQUIRE(problem);
    DesignEvaluation at = problem->evaluate(values_of(problem->design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    return at;
}

struct Dual {
    double value = 0, slope = 0;
};

// x of (1 + h^2 w) x_n+1 = 2 x_n - x_n-1, from rest at 1, after n steps; and its derivative in w, the square of the circular frequency.
Dual oscillator(double w, double h, int n) {
    Dual before{1, 0}, now{1, 0};
    for (int k = 0; k < n; ++k) {
        const double a = 1 + h * h * w, right = 2 * now.value - before.value;
        const Dual next{right / a, (2 * now.slope - before.slope) / a - right * h * h / (a * a)};
        before = now;
        now = next;
    }
    return now;
}

// A flat block on a plate, both with their file frames' origins at the world's, at rest on its contacts under `weight` [N].
constexpr double block_dhat = 1e-3, block_kappa = 1e3, block_mass = 0.1;
Design block_on_plate(double weight, double mu, double h, int steps) {
    const auto parameters = core::contact::barrier_parameters(block_dhat, 0, block_kappa, 1);
    const auto force = [&](double d) { return -2 * parameters.factor * core::contact::barrier(d * d, parameters.gap_hat).first * d; };
    double low = 0, high = block_dhat;
    while (high - low > 1e-15) (force(0.5 * (low + high)) > 0.25 * weight ? low : high) = 0.5 * (low + high);
    Design design;
    core::scene::Body plate = bar("plate", 1), block = bar("block", 1);
    plate.mesh = tests::support::box_mesh({-1, -1, -0.1}, {3, 1, 0});
    plate.type = core::scene::BodyType::static_body;
    for (auto& dof : plate.prescribed) dof = core::scene::MotionCurve{};
    block.mesh = tests::support::box_mesh({-0.05, -0.05, low}, {0.05, 0.05, low + 0.01});
    design.scene = scene_of({plate, block}, h);
    for (core::scene::Body& body : design.scene.bodies) body.group = -1;
    design.scene.gravity = Vector3(0, 0, -gravity);
    design.scene.dhat = block_dhat;
    design.scene.kappa = block_kappa;
    design.scene.friction.mu = mu;
    design.steps = steps;
    return design;
}

}  // namespace

TEST_CASE("closed form: the range of a throw in speed and angle", "[throw]") {
    constexpr double speed = 4, angle = 0.7, h = 0.01;
    const auto thrown = [&](core::scene::Integrator integrator, double step) {
        Design design;
        design.scene = scene_of({bar("stone", 0.1)}, step);
        design.scene.integrator = integrator;
        design.scene.gravity = Vector3(0, 0, -gravity);
        design.scene.bodies[0].linear_velocity = speed * Vector3(std::cos(angle), 0, std::sin(angle));
        design.scene.bodies[0].reference_point = Vector3(0.05, 0, 0);
        design.scene.bodies[0].pose.position = Vector3(-0.05, 0, 0);
        design.steps = static_cast<int>(std::lround(0.4 / step));
        add_parameters(design, {{"forwards", speed * std::cos(angle), "/bodies/0/linear_velocity/0"},
                                {"upwards", speed * std::sin(angle), "/bodies/0/linear_velocity/2"}});
        return evaluated(std::move(design), {std::make_shared<Landing>()});
    };
    const double range = speed * speed * std::sin(2 * angle) / gravity, by_speed = 2 * range / speed,
                 by_angle = 2 * speed * speed * std::cos(2 * angle) / gravity;
    const auto errors_of = [&](const DesignEvaluation& at) {
        const Vector2 direction(std::cos(angle), std::sin(angle)), across(-std::sin(angle), std::cos(angle));
        return Vector3(at.constraints[0].value - range, at.jacobian.row(0).dot(direction) - by_speed,
                       at.jacobian.row(0).dot(speed * across) - by_angle);
    };
    CHECK(errors_of(thrown(core::scene::Integrator::newmark, h)).norm() < 1e-9);  // whose free fall is exact
    const Vector3 coarse = errors_of(thrown(core::scene::Integrator::implicit_euler, h)),
                  fine = errors_of(thrown(core::scene::Integrator::implicit_euler, h / 2));
    for (int k = 0; k < 3; ++k) {
        CAPTURE(k, coarse[k], fine[k]);
        CHECK(std::abs(fine[k]) < 0.02);
        CHECK(coarse[k] / fine[k] == Approx(2).epsilon(0.05));
    }
}

TEST_CASE("closed form: a double pendulum keeps its energy, which follows gravity and density", "[joints]") {
    const auto swung = [](double h) {
        Design design;
        design.scene =
            scene_of({bar("upper", 0.3, Vector3::Zero(), Vector3(0, 0.4, 0)),
                      bar("lower", 0.2, core::kinematics::rotation(Vector3(0, 0.4, 0)) * Vector3(0.3, 0, 0), Vector3(0, -0.5, 0))},
                     h);
        design.scene.gravity = Vector3(0, 0, -gravity);
        design.steps = static_cast<int>(std::lround(0.4 / h));
        design.scene.mechanism.joints = {
            joint("pivot", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"upper", Vector3::Zero(), y_axis}),
            joint("elbow", JointKind::revolute, {"upper", Vector3(0.3, 0, 0), y_axis}, {"lower", Vector3::Zero(), y_axis})};
        add_parameters(design, {{"gravity", -gravity, "/gravity/2"}, {"density", 1000, "/bodies/1/density"}});
        const auto energy = std::make_shared<quantities::Energy>(quantities::EnergyKind::total, quantities::Over::end);
        return evaluated(std::move(design), {energy});
    };
    // At the start: both at rest, their centres at these heights.
    const double a = 0.4, area = 0.02 * 0.02, upper = -0.15 * std::sin(a), lower = -0.3 * std::sin(a) + 0.1 * std::sin(0.5);
    const double moment = 1000 * area * (0.3 * upper + 0.2 * lower);
    const Vector3 exact(gravity * moment, -moment, gravity * area * 0.2 * lower);
    const auto errors_of = [&](double h) {
        const DesignEvaluation at = swung(h);
        return Vector3((Vector3(at.constraints[0].value, at.jacobian(0, 0), at.jacobian(0, 1)) - exact).cwiseQuotient(exact));
    };
    const Vector3 coarse = errors_of(5e-4), fine = errors_of(2.5e-4);
    for (int k = 0; k < 3; ++k) {
        CAPTURE(k, coarse[k], fine[k]);
        CHECK(std::abs(fine[k]) < 0.08);
        CHECK(std::abs(coarse[k] / fine[k] - 2) < 0.05);
        CHECK(std::abs(2 * fine[k] - coarse[k]) < 4e-3);  // extrapolated to no step
    }
}

TEST_CASE("closed form: two equal bodies exchange their velocities", "[contact]") {
    // x_1, x_2, v_1, v_2 at the start; where the one that is struck is after a second: x_1 + v_1 and the bodies' length.
    const auto struck = [](double dhat, double h) {
        Design design;
        // Wide, so that contact is between their faces alone.
        const Vector3 straight = Vector3::Zero();
        design.scene = scene_of({bar("first", 0.1, Vector3(-0.4, 0, 0), straight, 0.2), bar("second", 0.1, straight, straight, 0.2)}, h);
        design.scene.integrator = core::scene::Integrator::newmark;
        for (core::scene::Body& body : design.scene.bodies) {
            body.group = -1;
            for (const int dof : {1, 2, 3, 4, 5}) body.prescribed[dof] = core::scene::MotionCurve{};
        }
        design.scene.bodies[0].linear_velocity = Vector3(1, 0, 0);
        design.scene.dhat = dhat;
        design.scene.kappa = 0.33 / dhat / dhat;  // turns them round deep within dhat
        design.steps = static_cast<int>(std::lround(1 / h));
        for (const bool is_place : {true, false})
            for (const int body : {0, 1}) {
                const double value = body == 1 ? 0 : is_place ? -0.4 : 1;
                add_parameter(design, {std::to_string(design.parameters.size()), value,
                                       "/bodies/" + std::to_string(body) + (is_place ? "/position/0" : "/linear_velocity/0")});
                design.parameters.back().lower = value - 1;
                design.parameters.back().upper = value + 1;
            }
        const DesignEvaluation at = evaluated(std::move(design), {std::make_shared<EndPosition>(1, Vector3::Zero(), x_axis)});
        Eigen::Matrix<double, 5, 1> out;
        out << at.constraints[0].value, at.jacobian.row(0).transpose();
        return out;
    };
    const Eigen::Matrix<double, 5, 1> exact = (Eigen::Matrix<double, 5, 1>() << -0.4 + 1 + 0.1, 1, 0, 1, 0).finished();
    // The impact begins before the bodies touch, and how deep they go hangs on their speed: lengths in proportion to dhat, as kappa dhat^2
    // is the same. What the steps lack is less the more of them the impact takes (h v/dhat squared): here hundreds.
    const Eigen::Matrix<double, 5, 1> narrow = struck(0.04, 2e-4) - exact, wide = struck(0.08, 2e-4) - exact, none = 2 * narrow - wide;
    CAPTURE(narrow.transpose(), wide.transpose(), none.transpose());
    CHECK(wide[0] / narrow[0] == Approx(2).epsilon(1e-3));
    for (const int k : {3, 4}) CHECK(wide[k] / narrow[k] == Approx(2).epsilon(0.02));  // derivatives in velocities
    for (const int k : {1, 2}) CHECK(std::abs(narrow[k]) < 1e-3);                      // in places
    CHECK(std::abs(none[0]) < 1e-5);
    CHECK(none.tail<4>().lpNorm<Eigen::Infinity>() < 2e-3);
}

TEST_CASE("closed form: a mass on a spring, in stiffness, mass and rest", "[joints]") {
    constexpr double h = 0.01, stiffness = 30, start = 0.05;
    constexpr int steps = 40;
    Design design;
    design.scene = scene_of({bar("mass", 0.2)}, h);
    design.steps = steps;
    core::scene::Joint slide = joint("slide", JointKind::prismatic, {"", Vector3::Zero(), x_axis}, {"mass", Vector3::Zero(), x_axis});
    slide.forces.stiffness = stiffness;
    slide.forces.rest = -start;
    design.scene.mechanism.joints = {slide};
    add_parameters(
        design,
        {{"stiffness", stiffness, "/joints/0/stiffness"}, {"density", 1000, "/bodies/0/density"}, {"rest", -start, "/joints/0/rest"}});
    const DesignEvaluation at = evaluated(design, {std::make_shared<EndPosition>(0, Vector3::Zero(), x_axis)});
    const double mass = 1000 * 0.2 * 0.02 * 0.02, w = stiffness / mass;
    const Dual x = oscillator(w, h, steps);
    CHECK(at.constraints[0].value == Approx(start * (x.value - 1)).epsilon(1e-9));
    CHECK(at.jacobian(0, 0) == Approx(start * x.slope / mass).epsilon(1e-9));
    CHECK(at.jacobian(0, 1) == Approx(-start * x.slope * w / 1000).epsilon(1e-9));
    CHECK(at.jacobian(0, 2) == Approx(1 - x.value).epsilon(1e-9));
}

TEST_CASE("closed form: a pendulum of small swings, in gravity and length", "[joints]") {
    constexpr double h = 0.01, length = 0.4, angle = 1e-5, half = 0.005;
    constexpr int steps = 60;
    Design design;
    design.scene = scene_of({bar("rod", 0.02, Vector3(-0.01, 0, -length), Vector3(0, 0, 0), half)}, h);
    design.steps = steps;
    design.scene.gravity = Vector3(0, 0, -9.81);
    // About the y axis through a point `length` above the bob's middle; the pivot is moved, and the bob hangs from it by that length.
    design.scene.mechanism.joints = {
        joint("pivot", JointKind::revolute, {"", Vector3::Zero(), y_axis}, {"rod", Vector3(0.01, 0, length), y_axis})};
    design.scene.bodies[0].pose.rotation = core::kinematics::rotation(Vector3(0, -angle, 0));
    design.scene.bodies[0].pose.position = -(design.scene.bodies[0].pose.rotation * Vector3(0.01, 0, length));
    const std::string reach = "/joints/0/point_b/2";
    add_parameters(design, {{"gravity", -9.81, "/gravity/2"}, {"length", length, reach}});
    // The swing's angle itself, from the direction of the rod's x axis.
    const auto tip = std::make_shared<EndPosition>(0, Vector3(1, 0, 0), z_axis),
               foot = std::make_shared<EndPosition>(0, Vector3::Zero(), z_axis);
    const DesignEvaluation at = evaluated(design, {tip, foot});
    const double about_middle = (0.02 * 0.02 + 4 * half * half) / 12;
    const auto square = [&](double g, double l) { return g * l / (about_middle + l * l); };
    const Dual x = oscillator(square(9.81, length), h, steps);
    const double swing = at.constraints[0].value - at.constraints[1].value;
    CHECK(swing == Approx(angle * x.value).epsilon(1e-6));
    const double by_gravity = -angle * x.slope * square(1, length);
    CHECK(at.jacobian(0, 0) - at.jacobian(1, 0) == Approx(by_gravity).epsilon(1e-6));
    constexpr double e = 1e-5;
    const double by_length = angle * x.slope * (square(9.81, length + e) - square(9.81, length - e)) / (2 * e);
    // The assembly moves the bob to the pivot's reach without turning it, but for the square of the angle.
    CHECK(at.jacobian(0, 1) - at.jacobian(1, 1) == Approx(by_length).epsilon(1e-5));
}

TEST_CASE("closed form: crank torque in load and crank radius", "[joints]") {
    constexpr double radius = 0.1, rod = 0.3, start = 0.4, load = -12;
    const double tilt = std::asin(radius * std::sin(start) / rod);
    const Vector3 pin(radius * std::cos(start), radius * std::sin(start), 0), wrist(pin.x() + rod * std::cos(tilt), 0, 0);
    Design design;
    design.scene = scene_of({bar("crank", radius, Vector3::Zero(), Vector3(0, 0, start)), bar("rod", rod, pin, Vector3(0, 0, -tilt)),
                             bar("slider", 0.05, wrist)},
                            0.01);
    design.scene.integrator = core::scene::Integrator::quasi_static;
    design.steps = 6;
    design.scene.mechanism.joints = {
        joint("main", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"crank", Vector3::Zero(), z_axis}),
        joint("pin", JointKind::ball, {"crank", Vector3(radius, 0, 0), z_axis}, {"rod", Vector3::Zero(), z_axis}),
        joint("wrist", JointKind::cylindrical, {"rod", Vector3(rod, 0, 0), z_axis}, {"slider", Vector3::Zero(), z_axis}),
        joint("guide", JointKind::prismatic, {"", wrist, x_axis}, {"slider", Vector3::Zero(), x_axis})};
    design.scene.mechanism.loads = {{"push", "", "slider", Vector3::Zero(), Vector3(load, 0, 0)}};
    design.scene.mechanism.motors = {motor("drive", "main", at_rate(2))};
    add_parameters(design, {{"load", load, "/loads/0/force/0"}, {"radius", radius, "/joints/1/point_a/0"}});
    using quantities::JointLoad;
    const DesignEvaluation at =
        evaluated(design, {std::make_shared<JointLoad>(JointLoad::Of{quantities::JointLoadKind::effort, "drive"}, quantities::Over::end)});
    // Virtual work: torque dtheta + load dx = 0.
    const auto torque = [&](double force, double r) {
        const double theta = start + 2 * 6 * 0.01, s = std::sin(theta), c = std::cos(theta);
        return force * (r * s + r * r * s * c / std::sqrt(rod * rod - r * r * s * s));
    };
    constexpr double e = 1e-5;
    CHECK(at.constraints[0].value == Approx(torque(load, radius)).epsilon(1e-5));
    CHECK(at.jacobian(0, 0) == Approx(torque(1, radius)).epsilon(1e-5));
    CHECK(at.jacobian(0, 1) == Approx((torque(load, radius + e) - torque(load, radius - e)) / (2 * e)).epsilon(1e-5));
}

TEST_CASE("closed form: a wheel behind a gear, in the ratio and the motor's speed", "[joints]") {
    Design design;
    design.scene = scene_of({bar("first", 0.1), bar("second", 0.1, Vector3(0.3, 0, 0))}, 0.01);
    design.steps = 10;
    design.scene.mechanism.joints = {
        joint("one", JointKind::revolute, {"", Vector3::Zero(), z_axis}, {"first", Vector3::Zero(), z_axis}),
        joint("two", JointKind::revolute, {"", Vector3(0.3, 0, 0), z_axis}, {"second", Vector3::Zero(), z_axis})};
    core::scene::Joint gear = joint("gear", JointKind::gear, {}, {});
    gear.of = {"one", "two"};
    gear.ratio = -0.6;
    design.scene.mechanism.joints.push_back(gear);
    design.scene.mechanism.motors = {motor("drive", "one", at_rate(5))};
    add_parameters(design, {{"ratio", -0.6, "/joints/2/ratio"}, {"speed", 5, "/motors/0/speed"}});
    const DesignEvaluation at = evaluated(design, {std::make_shared<EndPosition>(1, Vector3(0.1, 0, 0), y_axis)});
    const double angle = 5 * 0.1, turned = -0.6 * angle;
    CHECK(at.constraints[0].value == Approx(0.1 * std::sin(turned)).epsilon(1e-10));
    CHECK(at.jacobian(0, 0) == Approx(0.1 * std::cos(turned) * angle).epsilon(1e-9));
    CHECK(at.jacobian(0, 1) == Approx(0.1 * std::cos(turned) * -0.6 * 0.1).epsilon(1e-9));
}

TEST_CASE("closed form: what a hanging chain's joints carry, in density and gravity", "[joints]") {
    Design design;
    std::vector<core::scene::Body> links;
    for (int k = 0; k < 3; ++k)
        links.push_back(bar("link " + std::to_string(k), 0.2, Vector3(0, 0, -0.2 * k), Vector3(0, std::acos(0.0), 0)));
    design.scene = scene_of(links, 0.01);
    design.scene.integrator = core::scene::Integrator::quasi_static;
    design.scene.gravity = Vector3(0, 0, -9.81);
    design.steps = 2;
    for (int k = 0; k < 3; ++k)
        design.scene.mechanism.joints.push_back(
            joint("joint " + std::to_string(k), JointKind::revolute,
                  {k == 0 ? "" : "link " + std::to_string(k - 1), k == 0 ? Vector3(Vector3::Zero()) : Vector3(0.2, 0, 0), y_axis},
                  {"link " + std::to_string(k), Vector3::Zero(), y_axis}));
    for (int k = 0; k < 3; ++k) add_parameter(design, {"density " + std::to_string(k), 1000, "/bodies/" + std::to_string(k) + "/density"});
    add_parameter(design, {"gravity", -9.81, "/gravity/2"});
    using quantities::JointLoad;
    std::vector<std::shared_ptr<const Quantity>> loads;
    for (int k = 0; k < 3; ++k)
        loads.push_back(std::make_shared<JointLoad>(JointLoad::Of{quantities::JointLoadKind::force, "joint " + std::to_string(k), z_axis},
                                                    quantities::Over::end));
    const DesignEvaluation at = evaluated(design, loads);
    const double volume = 0.2 * 0.02 * 0.02;
    for (int k = 0; k < 3; ++k) {
        CAPTURE(k);
        CHECK(at.constraints[k].value == Approx((3 - k) * 1000 * volume * 9.81).epsilon(1e-8));
        for (int j = 0; j < 3; ++j) CHECK(at.jacobian(k, j) == Approx(j < k ? 0 : volume * 9.81).epsilon(1e-7).margin(1e-10));
        CHECK(at.jacobian(k, 3) == Approx(-(3 - k) * 1000 * volume).epsilon(1e-7));
    }
}

TEST_CASE("closed form: stopping distance in speed and friction", "[friction]") {
    constexpr double speed = 0.6, mu = 0.3, deceleration = mu * gravity, eps_v = 1e-3;
    const auto slid = [&](double h) {
        Design design = block_on_plate(block_mass * gravity, mu, h, static_cast<int>(0.3 / h));
        design.scene.bodies[1].linear_velocity = Vector3(speed, 0, 0);
        add_parameters(design, {{"speed", speed, "/bodies/1/linear_velocity/0"}, {"mu", mu, "/friction/mu"}});
        return evaluated(std::move(design), {std::make_shared<EndPosition>(1, Vector3::Zero(), x_axis)});
    };
    // As the steps are made: v' + a h f0'(v') = v, f0' = 2 u - u^2 at u = v'/eps_v < 1.
    struct Stop {
        double x = 0, by_speed = 0, by_mu = 0;
    };
    const auto steps_of = [&](double h) {
        Stop out;
        double v = speed, v_speed = 1, v_mu = 0;
        const double ah = deceleration * h;
        for (int k = 0; k < static_cast<int>(0.3 / h); ++k) {
            double next = v - ah, slope = 0;
            if (next < eps_v) {  // u^2 a h - u (eps_v + 2 a h) + v = 0
                const double b = eps_v + 2 * ah, root = std::sqrt(b * b - 4 * ah * v), u = 2 * v / (b + root);
                next = u * eps_v;
                slope = (2 - 2 * u) / eps_v;
            }
            const double rubbing = (v - next) / ah;  // f0'
            v_mu = (v_mu - gravity * h * rubbing) / (1 + ah * slope);
            v_speed /= 1 + ah * slope;
            v = next;
            out.x += h * v;
            out.by_speed += h * v_speed;
            out.by_mu += h * v_mu;
        }
        return out;
    };
    for (const double h : {0.01, 0.005, 0.0025}) {
        const DesignEvaluation at = slid(h);
        const Stop exact = steps_of(h);
        CAPTURE(h);
        CHECK(at.constraints[0].value == Approx(exact.x).epsilon(1e-4));
        CHECK(at.jacobian(0, 0) == Approx(exact.by_speed).epsilon(1e-3));
        CHECK(at.jacobian(0, 1) == Approx(exact.by_mu).epsilon(1e-3));
        // The continuous motion's, to the first order in h.
        const double lost = 0.5 * speed * h;
        CHECK(std::abs(at.constraints[0].value - speed * speed / (2 * deceleration)) < 1.1 * lost);
        CHECK(std::abs(at.jacobian(0, 0) - speed / deceleration) < 1.1 * h);
        CHECK(std::abs(at.jacobian(0, 1) + speed * speed / (2 * mu * deceleration)) < 1.1 * lost / mu);
    }
}

TEST_CASE("closed form: the way down an incline in angle and friction", "[friction]") {
    constexpr double angle = 0.5, mu = 0.2, time = 0.3;
    const double s = std::sin(angle), c = std::cos(angle), acceleration = gravity * (s - mu * c);
    const Vector3 down(c, 0, -s);
    const auto [h, rounds] = GENERATE(table<double, int>({{0.01, -1}, {0.005, -1}, {0.01, 1}, {0.005, 1}}));
    const int steps = static_cast<int>(std::lround(time / h));
    Design design = block_on_plate(block_mass * gravity * c, mu, h, steps);
    design.scene.friction.rounds = rounds;
    add_parameters(design, {{"angle", angle, "/bodies/0/turn/1"}, {"mu", mu, "/friction/mu"}});
    follow(design, "angle", "/bodies/1/turn/1");
    const DesignEvaluation at = evaluated(std::move(design), {std::make_shared<EndPosition>(1, Vector3::Zero(), down)});
    CAPTURE(h, rounds);
    const double half = 0.5 * h * h * steps * (steps + 1);  // h^2 (1 + ... + n); t^2/2 as h goes to 0
    CHECK(at.constraints[0].value == Approx(acceleration * half).epsilon(1e-4));
    // With one round the first step rubs with the normal forces of the start, which the angle does not change.
    const double rubbed = rounds == 1 ? half - h * h * steps : half;
    CHECK(at.jacobian(0, 0) == Approx(gravity * (c * half + mu * s * rubbed)).epsilon(1e-4));
    CHECK(at.jacobian(0, 0) == Approx(0.5 * gravity * (c + mu * s) * time * time).epsilon(1.1 * h / time));
    CHECK(at.jacobian(0, 1) == Approx(-gravity * c * half).epsilon(1e-3));
    // How long it takes for a given way: t = sqrt(2 way / acceleration), dt = - dway / speed.
    const double way = at.constraints[0].value, speed = acceleration * time;
    CHECK(time == Approx(std::sqrt(2 * way / acceleration)).epsilon(h / time));
    CHECK(-at.jacobian(0, 1) / speed == Approx(0.5 * time * gravity * c / acceleration).epsilon(1.1 * h / time));
}

}  // namespace fettle::design::problem::closed_forms_test
