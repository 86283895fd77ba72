// SPDX-License-Identifier: MIT
// Quasi-static steps against statics in closed form, and bodies that nothing holds.
#include "core/model/choose_proximal_weight.hpp"
#include "tests/core/stepper/physics_models.hpp"

namespace fettle::core::stepper::quasi_static_test {

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using core::scene::BodyType;
using core::stepper::SimulationStatus;

namespace {

const double pi = std::acos(-1.0);

core::model::Model still(std::vector<core::model::Body> bodies, const Vector3& acceleration = Vector3(0, 0, -gravity)) {
    core::model::Model model = world(std::move(bodies), 0.01);
    model.gravity = acceleration;
    model.integrator = core::scene::Integrator::quasi_static;
    model.diagonal = 2;
    model.kappa = core::model::choose_kappa(model);
    model.proximal_weight = core::model::choose_proximal_weight(model);
    return model;
}

core::model::Body cube(const std::string& name, double half, const Vector3& at) {
    return make_body(name, box_mesh(Vector3::Constant(-half), Vector3::Constant(half)), make_pose(Vector3::Zero(), at));
}

// Where a block that friction cannot hold is found to be not held: at most other places the solve gives up before it knows.
const Vector3 place(0.1, -0.7, 0);

core::stepper::Simulation attempt(const core::model::Model& model, int steps) {
    core::stepper::SimulationOptions options;
    options.steps = steps;
    return core::stepper::simulate(model, options);
}

const core::stepper::ContactForce& between(const core::stepper::StepOutputs& outputs, int a, int b) {
    for (const auto& f : outputs.contacts)
        if (f.a == a && f.b == b) return f;
    FAIL("no contact between " << a << " and " << b);
    return outputs.contacts.front();
}

void check_not_held(const core::stepper::Simulation& run, const std::string& name) {
    CHECK(run.report.status == SimulationStatus::not_held);
    CAPTURE(run.report.message);
    CHECK(run.report.message.find("'" + name + "'") != std::string::npos);
    CHECK(run.report.message.find("not held") != std::string::npos);
}

}  // namespace

TEST_CASE("a block that is let go is on the plate after one step, and its weight with it", "[physics][quasi_static]") {
    const core::model::Model model = still({cube("block", 0.05, place + Vector3(0, 0, 0.2)), ground_plate()});
    const auto rest = run(model, 3);
    const double weight = model.bodies[0].moments(3, 3) * gravity;
    for (int t = 0; t < 3; ++t) {
        CHECK(between(rest.outputs[t], 0, 1).force.z() == Approx(weight).epsilon(1e-6));
        CHECK(rest.outputs[t].kinetic_energy == 0);
        CHECK(rest.report.steps[t].residual < 1e-8);
        CHECK(rest.report.steps[t].proximal_share < 1e-6);
    }
    CHECK(between(rest.outputs[2], 0, 1).force.z() == Approx(weight).epsilon(1e-10));
    CHECK(position(rest, 1).z() < 0.05 + model.dhat);
    CHECK((position(rest, 3) - position(rest, 1)).norm() < 1e-9);
    CHECK((position(rest, 3) - position(rest, 0)).head<2>().norm() < 1e-7);  // nothing pushes it aside, so it goes nowhere
    for (const auto& body : rest.checkpoint.state.history.velocities) CHECK(body.isZero(0));
}

TEST_CASE("the step's length is no part of an equilibrium", "[physics][quasi_static]") {
    core::model::Model model = still({cube("block", 0.05, place + Vector3(0, 0, 0.0505)), ground_plate()});
    const auto one = run(model, 2);
    model.timestep = 1e-4;
    const auto other = run(model, 2);
    CHECK(position(one, 2) == position(other, 2));
}

// A lever about y through its pivot, two weights that are guided along z stand on it with an edge each.
TEST_CASE("a lever balances two weights where their moments and its own do", "[physics][quasi_static]") {
    struct Case {
        double arm_a, arm_b, half_a, half_b;
    };
    for (const Case& c : {Case{0.3, 0.3, 0.02, 0.02}, Case{0.4, 0.4 * 8 / 27, 0.02, 0.03}, Case{0.3, 0.31, 0.02, 0.02}}) {
        const double top = 0.01, low = -0.08;  // of the lever, from the pivot: its centre of mass is below
        core::model::Body lever =
            make_body("lever", box_mesh({-0.5, -0.05, low}, {0.5, 0.06, top}), make_pose(Vector3::Zero(), Vector3(0, 0, 1)));
        for (const int dof : {0, 1, 2, 3, 5}) prescribe(lever, dof);
        std::vector<core::model::Body> bodies{lever};
        const double diagonal = std::sqrt(2.0);
        for (const auto& [name, x, half] : {std::tuple{"a", -c.arm_a, c.half_a}, std::tuple{"b", c.arm_b, c.half_b}}) {
            core::model::Body weight = cube(name, half, Vector3(x, 0, 1 + top + diagonal * half + 5e-4));
            weight.pose_start.rotation = core::kinematics::rotation(Vector3(0, pi / 4, 0));
            for (const int dof : {0, 1, 3, 4, 5}) prescribe(weight, dof);
            bodies.push_back(weight);
        }
        const core::model::Model model = still(bodies);
        const auto balance = run(model, 2);
        const auto& poses = balance.trajectory.poses.back();
        const Vector3 along = poses[0].rotation.col(0), normal = poses[0].rotation.col(2), pivot = poses[0].position;
        // Each weight's normal force n carries it along z: n (normal . z) = m g. Moments about y, of the edges' feet on the lever.
        const double tilt = std::asin(-along.z());
        double moment = 0, scale = 0;
        for (const int i : {1, 2}) {
            const double mass = model.bodies[i].moments(3, 3), force = mass * gravity / normal.z();
            CHECK(between(balance.outputs.back(), 0, i).normal == Approx(force).epsilon(1e-6));
            const Vector3 edge = poses[i].position - Vector3(0, 0, diagonal * (i == 1 ? c.half_a : c.half_b));
            moment += force * (edge - pivot).dot(along);
            scale += force * 0.3;
        }
        const double own = model.bodies[0].moments(3, 3) * gravity, depth = -0.5 * (top + low);
        moment -= own * depth * std::sin(tilt);
        CAPTURE(c.arm_a, c.arm_b, tilt);
        CHECK(std::abs(moment) < 1e-6 * scale);
        // Where the moments are equal it stays level; a longer arm goes down.
        const double mass_a = model.bodies[1].moments(3, 3), mass_b = model.bodies[2].moments(3, 3);
        const double left = mass_a * c.arm_a, right = mass_b * c.arm_b;
        if (std::abs(left - right) < 1e-12 * left)
            CHECK(std::abs(tilt) < 1e-6);
        else
            CHECK(tilt > 1e-3);
    }
}

TEST_CASE("a beam on two supports loads them by the law of the lever", "[physics][quasi_static]") {
    // Two prisms' edges, at x = -0.3 and 0.2, off the beam's middle; a force beside its weight.
    const auto support_at = [](const char* name, double x) {
        return make_body(name, box_mesh({-0.02, -0.1, -0.02}, {0.02, 0.1, 0.02}),
                         make_pose(Vector3(0, pi / 4, 0), Vector3(x, 0, -0.02 * std::sqrt(2.0))), BodyType::static_body);
    };
    core::model::Body beam =
        make_body("beam", box_mesh({-0.5, -0.05, -0.01}, {0.5, 0.06, 0.01}), make_pose(Vector3::Zero(), Vector3(0, 0, 0.0106)));
    beam.force = Vector3(0, 0, -3);
    for (const int dof : {0, 1, 3, 5}) prescribe(beam, dof);  // as soon as it tilts, nothing else keeps it from sliding
    const core::model::Model model = still({beam, support_at("left", -0.3), support_at("right", 0.2)});
    const auto rest = run(model, 2);
    const double load = model.bodies[0].moments(3, 3) * gravity + 3;
    const double left = between(rest.outputs.back(), 0, 1).force.z(), right = between(rest.outputs.back(), 0, 2).force.z();
    CHECK(left + right == Approx(load).epsilon(1e-9));
    CHECK(left == Approx(load * 0.2 / 0.5).epsilon(1e-3));  // the beam tilts by a share of dhat, and the edges' feet with it
    CHECK(right == Approx(load * 0.3 / 0.5).epsilon(1e-3));
}

namespace {

core::model::Model incline(double angle, double mu) {
    core::model::Model model = still({cube("block", 0.05, place + Vector3(0, 0, 0.0505)), ground_plate()});
    model.gravity = gravity * Vector3(std::sin(angle), 0, -std::cos(angle));
    model.kappa = core::model::choose_kappa(model);
    model.friction.mu.setConstant(mu);
    return model;
}

}  // namespace

TEST_CASE("friction holds a block on an incline up to its angle, and nothing beyond", "[physics][quasi_static]") {
    const double angle = 0.4, tangent = std::tan(angle);
    const core::model::Model model = incline(angle, 1.05 * tangent);
    const auto rest = run(model, 4);
    const double weight = model.bodies[0].moments(3, 3) * gravity;
    for (int t = 0; t < 4; ++t) {
        CAPTURE(t);
        const auto& contact = between(rest.outputs[t], 0, 1);
        CHECK(contact.friction.x() == Approx(-weight * std::sin(angle)).epsilon(1e-6));
        CHECK(contact.normal == Approx(weight * std::cos(angle)).epsilon(1e-6));
        // Smoothed friction creeps by less than eps_v a step.
        const double creep = position(rest, t + 1).x() - position(rest, t).x();
        if (t == 0) continue;  // it falls onto the incline and tilts
        CHECK(creep > 0);
        CHECK(creep < model.friction.eps_v * model.timestep);
    }
    check_not_held(attempt(incline(angle, 0.95 * tangent), 2), "block");
    check_not_held(attempt(incline(angle, 0), 2), "block");
}

TEST_CASE("what nothing holds is named", "[physics][quasi_static]") {
    SECTION("in the air") { check_not_held(attempt(still({cube("stone", 0.05, Vector3(0, 0, 1))}), 1), "stone"); }
    SECTION("pushed off a plate by a force, while its neighbour stays") {
        core::model::Model model = still(
            {cube("pushed", 0.05, place + Vector3(0, 0, 0.0505)), cube("resting", 0.05, place + Vector3(0, 0.3, 0.0505)), ground_plate()});
        model.bodies[0].force = Vector3(0, -1e-2, 0);
        const auto run = attempt(model, 1);
        check_not_held(run, "pushed");
        CHECK(run.report.message.find("resting") == std::string::npos);
        CHECK(run.trajectory.steps.empty());
    }
    SECTION("turned by a torque") {
        core::model::Model model = still({cube("wheel", 0.05, Vector3(0, 0, 1))});
        for (const int dof : {0, 1, 2, 3, 4}) prescribe(model.bodies[0], dof);
        model.bodies[0].torque = Vector3(0, 0, 1e-3);
        check_not_held(attempt(model, 1), "wheel");
    }
    SECTION("a load that only the proximal term could carry, short of leaving the scene") {
        core::model::Model model = still({cube("drifting", 0.05, place + Vector3(0, 0, 0.0505)), ground_plate()});
        model.bodies[0].force = Vector3(0, -5e-6 * model.bodies[0].moments(3, 3) * gravity, 0);  // by W f/m: five times the scene's size
        check_not_held(attempt(model, 1), "drifting");
    }
}

TEST_CASE("what has no load needs nobody to hold it", "[physics][quasi_static]") {
    SECTION("a scene without loads: what is pushed goes along") {
        const Vector3 at = GENERATE(Vector3(0.102, 0.01, 0), Vector3(0.102, 0.01, 0.03), Vector3(0.1005, 0, 0.004));
        core::model::Model model = still({cube("pusher", 0.05, Vector3(0, 0, 0)), cube("box", 0.05, at)}, Vector3::Zero());
        for (int dof = 0; dof < 6; ++dof) prescribe(model.bodies[0], dof, dof == 0 ? 0.5 : 0);
        const auto pushed = run(model, 20);
        CHECK(position(pushed, 20, 0).x() == Approx(0.1).epsilon(1e-12));
        const double gap = position(pushed, 20, 1).x() - position(pushed, 20, 0).x() - 0.1;
        CHECK(gap > 0);
        CHECK(gap < 1.001 * model.dhat);
    }
    SECTION("a weightless body among loaded ones") {
        core::model::Model model = still(
            {cube("pusher", 0.05, Vector3(0, 0, 0)), cube("box", 0.05, Vector3(0.102, 0, 0)), cube("last", 0.05, Vector3(0.2035, 0, 0))},
            Vector3::Zero());
        for (int dof = 0; dof < 6; ++dof) prescribe(model.bodies[0], dof, dof == 0 ? 0.5 : 0);
        model.bodies[2].force = Vector3(-2, 0, 0);
        for (const int dof : {1, 2, 3, 4, 5})
            for (const int body : {1, 2}) prescribe(model.bodies[body], dof);
        model.kappa = core::model::choose_kappa(model);
        model.proximal_weight = core::model::choose_proximal_weight(model);
        const auto pushed = run(model, 10);
        for (const auto& step : pushed.report.steps) CHECK(step.proximal_share < 1e-6);
        CHECK(between(pushed.outputs.back(), 0, 1).force.x() == Approx(-2).epsilon(1e-6));
        CHECK(between(pushed.outputs.back(), 1, 2).force.x() == Approx(-2).epsilon(1e-6));
    }
}

TEST_CASE("a crank's torque follows from the slider's force by virtual work", "[physics][quasi_static]") {
    // A scotch yoke: the upright edge at the bar's end, at radius r, pushes a flat slider against F. x = r cos(angle), torque = F r
    // sin(angle).
    const double r = 0.2, force = 7, rate = 2 * pi / 0.8;
    core::model::Body crank = make_body("crank", box_mesh({-0.02, -0.02, -0.03}, {r / std::sqrt(2.0), r / std::sqrt(2.0), 0.03}),
                                        make_pose(Vector3::Zero(), Vector3::Zero()));
    for (int dof = 0; dof < 6; ++dof) prescribe(crank, dof, dof == 5 ? -rate : 0);
    core::model::Body slider = make_body("slider", box_mesh({0, -0.4, -0.05}, {0.05, 0.37, 0.04}),
                                         make_pose(Vector3::Zero(), Vector3(r / std::sqrt(2.0) + 9e-4, 0, 0)));
    for (const int dof : {1, 2, 3, 4, 5}) prescribe(slider, dof);
    slider.force = Vector3(-force, 0, 0);
    const core::model::Model model = still({crank, slider}, Vector3::Zero());
    const auto turn = run(model, 16);
    for (int t = 0; t < 16; ++t) {
        const double angle = pi / 4 - rate * (t + 1) * model.timestep;  // of the edge: from 45 degrees down to -27
        CAPTURE(t, angle);
        double torque = 0;
        for (const auto& drive : turn.outputs[t].drives)
            if (drive.body == 0) torque = drive.torque.z();
        CHECK(torque == Approx(-force * r * std::sin(angle)).margin(1e-6 * force * r));
        CHECK(position(turn, t + 1, 1).x() > r * std::cos(angle));
        CHECK(position(turn, t + 1, 1).x() < r * std::cos(angle) + 2 * model.dhat);
    }
}

TEST_CASE("boxes fall into a trough in one step, and their weight is carried", "[physics][quasi_static]") {
    const auto wall = [](const char* name, double side) {
        return make_body(name, box_mesh({-1, -1, -0.1}, {1, 1, 0}), make_pose(Vector3(0, -side * 0.6, 0), Vector3(side * 0.8, 0, 0)),
                         BodyType::static_body);
    };
    core::model::Model model =
        still({cube("first", 0.05, {0.02, -0.4, 0.3}), cube("second", 0.05, {-0.03, -0.41, 0.5}), wall("left", -1), wall("right", 1)});
    for (const int body : {0, 1})
        for (const int dof : {1, 3, 5}) prescribe(model.bodies[body], dof);  // along the trough nothing would keep them from sliding
    const auto rest = run(model, 2);
    for (const auto& step : rest.report.steps) CHECK(step.residual < 1e-8);
    double carried = 0;
    for (const auto& f : rest.outputs.back().contacts)
        if (f.b >= 2) carried += f.force.z();
    CHECK(carried == Approx(2 * model.bodies[0].moments(3, 3) * gravity).epsilon(1e-6));
}

}  // namespace fettle::core::stepper::quasi_static_test
