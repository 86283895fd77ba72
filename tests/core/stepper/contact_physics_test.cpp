// SPDX-License-Identifier: MIT
// Bodies in contact without friction, or with it between free bodies: what no force between bodies can change, and how energy behaves.
#include "core/clearance/clearance.hpp"
#include "tests/core/stepper/physics_models.hpp"
#include "tests/support/intersection_oracle.hpp"

namespace fettle::core::stepper::contact_physics_test {

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using core::scene::Integrator;

namespace {

core::geometry::Mesh cube(double a) { return box_mesh(Vector3::Constant(-a / 2), Vector3::Constant(a / 2)); }

/// Two cubes, off centre and askew, one fast.
core::model::Model collision(double h) {
    core::model::Body a = make_body("a", cube(0.2), make_pose(Vector3(0.1, 0.2, 0.3), Vector3(0, 0, 0)));
    core::model::Body b =
        make_body("b", cube(0.2), make_pose(Vector3(-0.3, 0.1, 0.2), Vector3(0.4, 0.06, -0.05)), core::scene::BodyType::dynamic_body, 2000);
    set_velocity(a, Vector3(2, 0, 0), Vector3(0, 0, 1));
    set_velocity(b, Vector3(-0.5, 0, 0.1), Vector3(0.5, 0, 0));
    return weightless({a, b}, h);
}

Vector3 start_momentum(const core::model::Model& model) {
    Vector3 sum = Vector3::Zero();
    for (const core::model::Body& body : model.bodies) sum += body.moments(3, 3) * body.velocity_start.col(3);
    return sum;
}

int steps_in_contact(const core::stepper::Simulation& simulation) {
    int count = 0;
    for (const auto& step : simulation.report.steps) count += step.contacts > 0;
    return count;
}

}  // namespace

TEST_CASE("linear momentum is exact under contact and friction, by every integrator and time step", "[physics]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark})
        for (const double mu : {0.0, 0.4})
            for (const double h : {0.01, 0.004}) {
                INFO("integrator " << static_cast<int>(integrator) << ", mu " << mu << ", h " << h);
                core::model::Model model = collision(h);
                model.integrator = integrator;
                set_friction(model, mu, 1e-3, 1);
                core::stepper::SimulationOptions options;
                options.steps = static_cast<int>(std::lround(0.24 / h));
                options.outputs = options.for_gradient = true;
                const auto flight = core::stepper::simulate(model, options);
                // Newmark's rule throws them apart with more energy than they had, by long steps.
                REQUIRE((flight.report.status == core::stepper::SimulationStatus::ok ||
                         (flight.report.status == core::stepper::SimulationStatus::energy_gained && integrator == Integrator::newmark)));
                REQUIRE(steps_in_contact(flight) > 0);
                const Vector3 start = start_momentum(model);
                for (const auto& step : flight.outputs) CHECK((step.linear_momentum - start).norm() < 1e-9 * start.norm());
                CHECK(find_intersections(model, flight.trajectory, 4).intersections.empty());
            }
}

TEST_CASE("angular momentum in a collision is kept within the integrator's order", "[physics]") {
    for (const double mu : {0.0, 0.4}) {
        std::vector<double> errors;
        for (const double h : {0.004, 0.001}) {
            core::model::Model model = collision(h);
            set_friction(model, mu, 1e-3);
            const auto flight = run(model, static_cast<int>(std::lround(0.24 / h)), true);
            REQUIRE(steps_in_contact(flight) > 0);
            const Vector3 start = flight.outputs.front().angular_momentum;
            errors.push_back((flight.outputs.back().angular_momentum - start).norm() / start.norm());
        }
        INFO("mu " << mu << ": " << errors[0] << " " << errors[1]);
        CHECK(errors[1] < 0.5 * errors[0]);
        CHECK(errors[1] < 0.05);
    }
}

TEST_CASE("contact forces are equal and opposite, and carry the weight at rest", "[physics]") {
    const core::model::Body low = make_body("low", cube(0.2), make_pose(Vector3::Zero(), Vector3(0, 0, 0.1005)));
    const core::model::Body high = make_body("high", cube(0.1), make_pose(Vector3::Zero(), Vector3(0, 0, 0.2512)));
    const core::model::Model model = world({low, high, ground_plate()}, 0.01);
    const auto stack = run(model, 150, true);
    const auto& end = stack.outputs.back();
    REQUIRE(end.contacts.size() == 2);  // (low, high), (low, ground)
    CHECK(end.contacts[0].force.z() == Approx(-high.moments(3, 3) * gravity).epsilon(1e-4));
    CHECK(end.contacts[0].normal == Approx(high.moments(3, 3) * gravity).epsilon(1e-4));
    CHECK(end.contacts[1].force.z() == Approx((low.moments(3, 3) + high.moments(3, 3)) * gravity).epsilon(1e-4));
    CHECK(end.contacts[1].distance > 0);
    CHECK(end.contacts[1].distance < model.dhat);
}

TEST_CASE("implicit Euler gains no energy in a fall and its bounces", "[physics]") {
    // Away from the plate's diagonal, where a vertex is a contact of two triangles.
    const core::model::Body body = make_body("cube", cube(0.1), make_pose(Vector3(0, 0, 0.3), Vector3(0.3, -0.2, 0.15)));
    for (const double h : {0.01, 0.002}) {
        const core::model::Model model = world({body, ground_plate()}, h);
        const auto fall = run(model, static_cast<int>(std::lround(0.6 / h)), true);
        double before = body.moments(3, 3) * gravity * 0.15 * (1 + 1e-12);
        for (const auto& step : fall.outputs) {
            const double now = step.kinetic_energy + step.potential_energy + step.contact_energy;
            CHECK(now <= before * (1 + 1e-9));
            before = now;
        }
    }
}

TEST_CASE("Newmark gives an elastic bounce back to the height it fell from", "[physics]") {
    // A step must resolve the contact: a soft barrier over 5 cm.
    const core::model::Body body = make_body("cube", cube(0.1), make_pose(Vector3::Zero(), Vector3(0, 0, 0.25)));
    core::model::Model model = world({body, ground_plate()}, 0.0005);
    model.dhat = 0.05;
    model.kappa = 2e3;
    model.integrator = Integrator::newmark;
    const auto bounce = run(model, 900, true);
    double highest_after = 0;
    bool touched = false;
    for (int n = 1; n <= 900; ++n) {
        touched |= bounce.report.steps[n - 1].contacts > 0;
        if (touched && velocity(bounce, n).z() > 0) highest_after = std::max(highest_after, position(bounce, n).z());
    }
    REQUIRE(touched);
    CHECK(highest_after == Approx(0.25).epsilon(2e-3));
}

TEST_CASE("A script that closes a gap altogether leaves what can be proven, whatever rounding does", "[physics]") {
    // A plate comes up to a cube that a force holds against it, until the cube fills the gap to a wall exactly.
    const auto plate = box_mesh({-0.05, -5, -5}, {0.05, 5, 5});
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        core::model::Model model =
            weightless({make_body("wall", plate, make_pose({0, 0, 0}, {1.05, 0, 0}), core::scene::BodyType::static_body),
                        make_body("cube", cube(1), make_pose({0, 0, 0}, {0, 0, 0}), core::scene::BodyType::dynamic_body, 1e4),
                        make_body("plate", plate, make_pose({0, 0, 0}, {-1.05, 0, 0}), core::scene::BodyType::kinematic_body)},
                       0.01);
        model.diagonal = 14;
        model.bodies[1].force = Vector3(-1e6 * (1 + 1e-6 * i), 0, 0);
        prescribe(model.bodies[2], 0, 1);
        const auto out = run(model, 100);
        CHECK(std::abs(out.trajectory.poses.back()[2].position.x() + 0.05) < 1e-9 * model.diagonal);
        core::clearance::ClearanceOptions options;
        options.motion = true;
        options.tolerance = 1e-12;
        const auto proven = core::clearance::certify(model, out.trajectory, {{0, 1, 0}, {1, 2, 0}}, options);
        for (const auto& pair : proven) CHECK(pair.lower > 0);
    }
}

}  // namespace fettle::core::stepper::contact_physics_test
