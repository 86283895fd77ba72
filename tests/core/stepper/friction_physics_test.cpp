// SPDX-License-Identifier: MIT
// Coulomb friction against closed forms.
#include "tests/core/stepper/physics_models.hpp"

namespace fettle::core::stepper::friction_physics_test {

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using core::scene::BodyType;

namespace {

const double pi = std::acos(-1.0);

/// A flat slab that rests on z = 0, its lower face `gap` above. Off the plate's diagonal: a vertex over an edge between two triangles of
/// one plane is a contact of both, and they push it aside.
core::model::Body slab(double x, double gap) {
    return make_body("slab", box_mesh({-0.1, -0.1, -0.02}, {0.1, 0.1, 0.02}), make_pose(Vector3::Zero(), Vector3(x, -0.7, 0.02 + gap)));
}

/// The model once its bodies have come to rest in contact, held by plenty of friction: started anywhere else, contact throws them up, and
/// what friction does not do while they fly is motion that stays.
core::model::Model at_rest(core::model::Model model) {
    core::model::Model sticky = model;
    set_friction(sticky, 2, 1e-5, 1);
    const auto settling = run(sticky, 200);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) model.bodies[i].pose_start = settling.trajectory.poses.back()[i];
    return model;
}

/// The slab on a plate, all tilted by `angle` about y; the slab slides towards +x.
core::model::Model incline(double angle, double mu) {
    core::model::Model model = world({slab(0, 9e-4), ground_plate()}, 0.005);
    const core::kinematics::Pose tilt = make_pose(Vector3(0, angle, 0), Vector3(1, 2, 3));
    for (core::model::Body& body : model.bodies)
        body.pose_start = {tilt.rotation * body.pose_start.rotation, core::kinematics::world_position(tilt, body.pose_start.position)};
    set_friction(model, mu, 1e-5);
    return at_rest(model);
}

/// A prism with `n` sides along y, its axis through the origin.
core::geometry::Mesh cylinder(int n, double radius, double half_length) {
    Matrix3X v(3, 2 * n + 2);
    std::vector<core::geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * i / n;
        v.col(i) << radius * std::cos(angle), -half_length, radius * std::sin(angle);
        v.col(n + i) << radius * std::cos(angle), half_length, radius * std::sin(angle);
        const int j = (i + 1) % n;
        triangles.push_back({i, j, n + i});
        triangles.push_back({j, n + j, n + i});
        triangles.push_back({2 * n, j, i});
        triangles.push_back({2 * n + 1, n + i, n + j});
    }
    v.col(2 * n) << 0, -half_length, 0;
    v.col(2 * n + 1) << 0, half_length, 0;
    for (auto& t : triangles) std::swap(t[1], t[2]);
    return core::geometry::make_mesh("cylinder", v, triangles);
}

/// A cone with `n` sides, its apex at the origin, its axis along x.
core::geometry::Mesh cone(int n, double height, double radius) {
    Matrix3X v(3, n + 2);
    std::vector<core::geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * (i + 0.5) / n;
        v.col(i) << height, radius * std::cos(angle), radius * std::sin(angle);
        triangles.push_back({n, (i + 1) % n, i});
        triangles.push_back({n + 1, i, (i + 1) % n});
    }
    v.col(n) << 0, 0, 0;
    v.col(n + 1) << height, 0, 0;
    return core::geometry::make_mesh("cone", v, triangles);
}

/// A slab on a table that turns with angular velocity `omega` about z, and with it if `along`.
core::model::Model turntable(double mu, double omega, double radius, bool along) {
    core::model::Body table = ground_plate();
    table.type = BodyType::kinematic_body;
    table.name = "table";
    const core::model::Body load =
        make_body("load", box_mesh({-0.05, -0.05, -0.01}, {0.05, 0.05, 0.01}), make_pose(Vector3::Zero(), Vector3(radius, 0, 0.01 + 9e-4)));
    core::model::Model model = at_rest(world({load, table}, 0.005));
    prescribe(model.bodies[1], 5, omega);
    if (along) set_velocity(model.bodies[0], Vector3(0, omega * radius, 0), Vector3(0, 0, omega));
    set_friction(model, mu, 1e-5);
    return model;
}

double distance_from_axis(const core::stepper::Simulation& simulation, int step) { return position(simulation, step).head<2>().norm(); }

}  // namespace

TEST_CASE("a sliding slab loses mu times the impulse that its contact carries", "[physics]") {
    for (const double mu : {0.1, 0.3, 0.8}) {
        INFO("mu " << mu);
        core::model::Model model = world({slab(-1, 5e-4), ground_plate()}, 0.005);
        set_velocity(model.bodies[0], Vector3(2, 0, 0), Vector3::Zero());
        set_friction(model, mu, 1e-4);
        const auto slide = run(model, 100);
        // While it slides: v_x = v_0 - mu (g t + v_z), whatever the normal force does meanwhile.
        for (int n = 1; n <= 40; ++n) {
            const Vector3 v = velocity(slide, n);
            const double expected = 2 - mu * (gravity * n * model.timestep + v.z());
            if (expected < 0.1) break;
            CHECK(v.x() == Approx(expected).epsilon(2e-3));
        }
        const int stop = static_cast<int>(std::ceil(2 / (mu * gravity) / model.timestep)) + 5;
        if (stop >= 100) continue;
        // Implicit Euler's stopping distance: the sum of its velocities.
        CHECK(position(slide, 100).x() + 1 == Approx(2 * 2 / (2 * mu * gravity) - model.timestep).margin(2 * model.timestep));
        CHECK(velocity(slide, 100).norm() < model.friction.eps_v);
    }
}

namespace {

/// The slab on its way at 2 m/s, `room` before a wall.
core::model::Model slide_to_wall(double room) {
    const double front = -1 + 0.1;
    std::vector<core::model::Body> bodies{slab(-1, 5e-4), ground_plate()};
    const core::kinematics::Pose beyond = make_pose(Vector3::Zero(), Vector3(front + room, 0, 0));
    bodies.push_back(make_body("wall", box_mesh({0, -1, 0.01}, {0.1, 0, 0.2}), beyond, BodyType::static_body));
    core::model::Model model = world(std::move(bodies), 0.005);
    set_velocity(model.bodies[0], Vector3(2, 0, 0), Vector3::Zero());
    set_friction(model, 0.1, 1e-4);
    return model;
}

}  // namespace

TEST_CASE("what slides need not get going in each step: three iterations at most, but after a checkpoint", "[physics]") {
    const auto slide = run(slide_to_wall(1), 80);
    for (int t = 5; t < 80; ++t) {
        if (t % checkpoint_interval < 2) continue;  // a step begins where it starts until the one before it is known
        INFO("step " << t);
        CHECK(slide.report.steps[t].newton_iterations <= 3);
    }
}

TEST_CASE("what slides is stopped by a wall where it would have gone through", "[physics]") {
    for (const double room : {2.1e-2, 2.5e-2, 3e-2}) {  // of 1 cm a step
        INFO("room " << room);
        const auto slide = run(slide_to_wall(room), 20);
        for (int t = 1; t <= 20; ++t) CHECK(position(slide, t).x() < -1 + room);
        CHECK(velocity(slide, 20).x() < 0.1);
    }
}

TEST_CASE("a run goes on from a checkpoint as it would have, bit for bit, where bodies slide", "[physics]") {
    const core::model::Model model = slide_to_wall(1);
    SimulationOptions options;
    options.steps = 70;
    const Simulation whole = simulate(model, options);
    options.steps = 40;
    const Simulation part = simulate(model, options);
    REQUIRE(part.checkpoint.step == checkpoint_interval);
    options.steps = 70;
    options.resume = &part;
    const Simulation resumed = simulate(model, options);
    REQUIRE(resumed.trajectory.poses.size() == whole.trajectory.poses.size());
    for (int t = 0; t <= 70; ++t) {
        INFO("step " << t);
        CHECK(position(resumed, t) == position(whole, t));
        CHECK(rotation(resumed, t) == rotation(whole, t));
    }
    CHECK(resumed.report.newton_iterations == whole.report.newton_iterations);
}

TEST_CASE("a block on the incline slides at mu 0.49 and stays at 0.5", "[physics]") {
    const double angle = 26.565 * pi / 180;  // tan = 0.499998
    const Vector3 down(std::cos(angle), 0, -std::sin(angle));
    {
        const auto slide = run(incline(angle, 0.49), 200);
        const double found = (velocity(slide, 200) - velocity(slide, 100)).dot(down) / 0.5;
        CHECK(found == Approx(gravity * (std::sin(angle) - 0.49 * std::cos(angle))).epsilon(0.01));
    }
    {
        const auto stick = run(incline(angle, 0.5), 400);
        // Smoothed friction creeps, below its static speed bound.
        CHECK((position(stick, 400) - position(stick, 200)).norm() <= 1.01e-5 * 1.0);
        CHECK((position(stick, 400) - position(stick, 0)).norm() < 1e-4);
    }
}

TEST_CASE("a turntable keeps its load up to omega^2 r = mu g and not beyond", "[physics]") {
    const double radius = 0.5;
    for (const double mu : {0.1, 0.5, 1.0}) {
        const double critical = std::sqrt(mu * gravity / radius);
        INFO("mu " << mu);
        {
            const auto kept = run(turntable(mu, 0.97 * critical, radius, true), 400);
            CHECK(std::abs(distance_from_axis(kept, 400) - radius) < 2e-3);
            // It goes round with the table.
            const double turned = 0.97 * critical * 2.0;
            const Vector3 expected = core::kinematics::rotation(Vector3(0, 0, turned)) * Vector3(radius, 0, 0);
            CHECK((position(kept, 400).head<2>() - expected.head<2>()).norm() < 5e-3);
        }
        const auto left = run(turntable(mu, 1.03 * critical, radius, true), 400);
        CHECK(distance_from_axis(left, 400) > radius + 0.02);
    }
}

TEST_CASE("a turntable without friction turns away under its load", "[physics]") {
    const auto still = run(turntable(0, 3, 0.5, false), 200);
    // Not rounding level: the edge between the table's two triangles passes below, where a vertex is a contact of both (see slab above).
    CHECK((position(still, 200) - position(still, 0)).head<2>().norm() < 5e-4);
    CHECK((rotation(still, 200) - Matrix3::Identity()).norm() < 0.02);
}

TEST_CASE("a cylinder rolls down an incline with two thirds of the slope's acceleration", "[physics]") {
    const double angle = 0.2, radius = 0.1;
    core::model::Body roller = make_body("roller", cylinder(384, radius, 0.05), make_pose(Vector3::Zero(), Vector3(-1, 0, radius + 3e-4)));
    core::model::Model model = world({roller, ground_plate()}, 0.005);
    model.gravity = gravity * Vector3(std::sin(angle), 0, -std::cos(angle));
    model.integrator = core::scene::Integrator::bdf2;  // implicit Euler brakes the spin at the rate h omega^2
    set_friction(model, 0.5, 1e-4);
    const auto rolling = run(model, 160);
    const double expected = gravity * std::sin(angle) / (1 + inertia(roller)(1, 1) / (roller.moments(3, 3) * radius * radius));
    CHECK(expected == Approx(2.0 / 3 * gravity * std::sin(angle)).epsilon(2e-3));
    const double found = (velocity(rolling, 160).x() - velocity(rolling, 40).x()) / (120 * model.timestep);
    CHECK(found == Approx(expected).epsilon(0.02));
    // Without slip: the point of contact rests.
    const Matrix3 step_rotation = rotation(rolling, 160) * rotation(rolling, 159).transpose();
    const double spin = core::kinematics::rotation_vector(step_rotation).y() / model.timestep;
    CHECK(spin * radius == Approx(velocity(rolling, 160).x()).epsilon(0.01));
}

TEST_CASE("a cone rolls round its apex", "[physics]") {
    const double height = 0.1, radius = 0.05, half_angle = std::atan(radius / height), rate = 2;
    const core::model::Body body = make_body("cone", cone(256, height, radius), make_pose({0, -half_angle, 0}, {0, 0, 5e-4}));
    core::model::Model model = world({body, ground_plate()}, 0.0025);
    set_friction(model, 0.5, 1e-4);
    model = at_rest(model);
    // About the apex at `rate`, the line of contact at rest: omega = -rate cot(half_angle) along it.
    const Vector3 start = model.bodies[0].pose_start.position;
    set_velocity(model.bodies[0], Vector3::Zero(), Vector3(-rate * height / radius, 0, 0));
    const auto rolling = run(model, 240);
    // Landau and Lifshitz, Mechanics, section 32, problem 7: T = 3 m h^2 rate^2 (1 + 5 cos^2) / 40
    const double cosine = std::cos(half_angle);
    const double energy = 3.0 / 40 * body.moments(3, 3) * height * height * rate * rate * (1 + 5 * cosine * cosine);
    CHECK(rolling.outputs.front().kinetic_energy == Approx(energy).epsilon(0.02));
    const Vector3 axis = rotation(rolling, 240).col(0);
    CHECK(std::atan2(axis.y(), axis.x()) == Approx(rate * 0.6).epsilon(0.05));
    CHECK((position(rolling, 240) - start).norm() < 2e-3);
    CHECK(axis.z() == Approx(std::sin(half_angle)).margin(0.01));
}

}  // namespace fettle::core::stepper::friction_physics_test
