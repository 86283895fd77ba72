// SPDX-License-Identifier: MIT
// Energies, momenta, contact forces and drive forces of a step against what mechanics says they are.
#include "core/stepper/step_outputs.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "core/records/step_tables.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::stepper::step_outputs_test {

using namespace fettle::tests::support;

namespace {

model::Model model_of(std::vector<model::Body> bodies) {
    model::Model model;
    model.bodies = std::move(bodies);
    model.gravity = Vector3(0, 0, -9.81);
    model.dhat = 1e-3;
    model.diagonal = 4;
    model.velocity_tolerance = 1e-6;
    model.kappa = model::choose_kappa(model);
    return model;
}

Simulation run(const model::Model& model, int steps) {
    SimulationOptions options;
    options.steps = steps;
    options.outputs = true;
    Simulation simulation = simulate(model, options);
    INFO(simulation.report.message);
    REQUIRE(simulation.report.status == SimulationStatus::ok);
    REQUIRE(count_of(simulation.outputs) == steps);
    return simulation;
}

model::Body box_at(const std::string& name, const Vector3& position) {
    return make_body(name, box_mesh(Vector3(-0.2, -0.1, -0.05), Vector3(0.2, 0.1, 0.05)), make_pose(Vector3::Zero(), position));
}

}  // namespace

TEST_CASE("a flying body's energy and momenta", "[step_outputs]") {
    model::Model model = model_of({box_at("box", Vector3(1, 2, 3))});
    const Vector3 v(1, -2, 0.5), w(0.3, 0.1, 2);
    set_velocity(model.bodies[0], v, w);
    model.gravity.setZero();
    const StepOutputs o = run(model, 1).outputs[0];
    const double mass = 1000 * 0.4 * 0.2 * 0.1;
    const Vector3 inertia = mass / 12 * Vector3(0.2 * 0.2 + 0.1 * 0.1, 0.4 * 0.4 + 0.1 * 0.1, 0.4 * 0.4 + 0.2 * 0.2);
    CHECK((o.linear_momentum - mass * v).norm() < 1e-10 * mass);
    // Implicit Euler turns it by h w with Pdot the difference of the poses: first order in h.
    const double h = model.timestep;
    CHECK(o.kinetic_energy == Approx(0.5 * mass * v.squaredNorm() + 0.5 * w.dot(inertia.cwiseProduct(w))).epsilon(3 * h * w.norm()));
    const Vector3 spin = inertia.cwiseProduct(w), orbit = mass * Vector3(1, 2, 3).cross(v);
    CHECK((o.angular_momentum - orbit - spin).norm() < 3 * h * w.norm() * spin.norm());
    CHECK(o.contacts.empty());
    CHECK(o.drives.empty());
    CHECK(o.potential_energy == 0);
}

TEST_CASE("a resting box is carried by its weight", "[step_outputs]") {
    const model::Model model = model_of({ground_plate(), box_at("box", Vector3(0.3, 0.2, 0.0508))});
    const Simulation simulation = run(model, 300);
    const StepOutputs& o = simulation.outputs.back();
    const double weight = 8 * 9.81;
    REQUIRE(o.contacts.size() == 1);
    const ContactForce& f = o.contacts[0];
    CHECK(f.a == 0);
    CHECK(f.b == 1);
    CHECK((f.force - Vector3(0, 0, -weight)).norm() < 1e-4 * weight);
    const Vector3 at = simulation.trajectory.poses.back()[1].position;
    CHECK((f.torque - at.cross(Vector3(0, 0, -weight))).norm() < 1e-3 * weight);
    CHECK(f.normal == Approx(weight).epsilon(1e-3));
    CHECK(f.friction.isZero(0));
    CHECK(f.distance == Approx(simulation.report.steps.back().minimum_distance));
    CHECK(o.contact_energy > 0);
    CHECK(o.potential_energy == Approx(weight * simulation.trajectory.poses.back()[1].position.z()));
    // The plate is held against that force: what drives it is its opposite.
    REQUIRE(o.drives.size() == 1);
    CHECK(o.drives[0].body == 0);
    CHECK((o.drives[0].force - Vector3(0, 0, weight)).norm() < 1e-4 * weight);
}

TEST_CASE("friction is part of the contact force", "[step_outputs]") {
    model::Model model = model_of({ground_plate(), box_at("box", Vector3(0, 0, 0.0508))});
    model.friction.mu = MatrixX::Constant(1, 1, 0.25);
    set_velocity(model.bodies[1], Vector3(2, 0, 0), Vector3::Zero());
    const StepOutputs o = run(model, 30).outputs.back();
    REQUIRE(o.contacts.size() == 1);
    CHECK(o.contacts[0].friction.x() == Approx(0.25 * 8 * 9.81).epsilon(0.02));  // on the plate: along the sliding
    CHECK(std::abs(o.contacts[0].friction.y()) < 1e-3 * 8 * 9.81);
}

TEST_CASE("a motor supplies weight, inertia and torque", "[step_outputs]") {
    // Turned about z off its centre and held otherwise, from rest to a constant rate in one step.
    model::Body body =
        make_body("arm", box_mesh(Vector3(0, -0.1, -0.05), Vector3(0.4, 0.1, 0.05)), make_pose(Vector3::Zero(), Vector3::Zero()));
    for (int k = 0; k < 6; ++k) prescribe(body, k, k == 5 ? 0.7 : 0.0);
    const model::Model model = model_of({body});
    const Simulation simulation = run(model, 3);
    const double mass = 8, h = model.timestep, rate = 0.7;
    const double about_pivot = mass * (0.4 * 0.4 + 0.2 * 0.2) / 12 + mass * 0.2 * 0.2;
    REQUIRE(simulation.outputs[0].drives.size() == 1);
    const DriveForce start = simulation.outputs[0].drives[0], steady = simulation.outputs[2].drives[0];
    CHECK(start.torque.z() == Approx(about_pivot * rate / h).epsilon(1e-3));
    CHECK(start.force.z() == Approx(mass * 9.81).epsilon(1e-9));
    CHECK(start.torque.y() == Approx(-0.2 * mass * 9.81).epsilon(1e-3));
    // Steady: the centripetal force alone, m w^2 r towards the pivot; the arm points along x to within the angle turned.
    CHECK(std::hypot(steady.force.x(), steady.force.y()) == Approx(mass * rate * rate * 0.2).epsilon(0.02));
    CHECK(std::abs(steady.torque.z()) < 1e-2 * about_pivot * rate);
}

TEST_CASE("tables have a header and a row per step", "[step_outputs]") {
    const model::Model model = model_of({ground_plate(), box_at("box, \"big\"", Vector3(0, 0, 0.0508))});
    const Simulation simulation = run(model, 4);
    const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
    const auto columns = [](const std::string& text) {
        return std::count(text.begin(), text.begin() + static_cast<long>(text.find('\n')), ',');
    };
    const std::string steps = records::steps_csv(simulation);
    CHECK(lines(steps) == 5);
    CHECK(columns(steps) == 18);
    const std::vector<std::string> names{"ground", "box, \"big\""};
    const std::string contacts = records::contacts_csv(simulation, names);
    CHECK(lines(contacts) == 5);
    CHECK(contacts.find("ground,\"box, \"\"big\"\"\",") != std::string::npos);
    CHECK(columns(records::drives_csv(simulation, names)) == 7);
}

TEST_CASE("tables of a run that was taken up again are those of one that was never cut", "[step_outputs]") {
    const model::Model model = model_of({ground_plate(), box_at("two\nlines", Vector3(0, 0, 0.0508))});
    const std::vector<std::string> names{"ground", "two\nlines"};
    const Simulation whole = run(model, 7);
    // The first run got to step 5; its checkpoint was at 3.
    Simulation earlier = whole, later = whole;
    earlier.outputs.resize(5);
    earlier.report.steps.resize(5);
    later.outputs.erase(later.outputs.begin(), later.outputs.begin() + 3);
    const double until = 3.5 * model.timestep;
    CHECK(records::joined_table(records::steps_csv(earlier), records::steps_csv(later), until) == records::steps_csv(whole));
    CHECK(records::joined_table(records::contacts_csv(earlier, names), records::contacts_csv(later, names), until) ==
          records::contacts_csv(whole, names));
    CHECK(records::joined_table("time,other\n0.01,2\n", records::steps_csv(later), until) == records::steps_csv(later));
    CHECK(records::joined_table("", records::steps_csv(later), until) == records::steps_csv(later));
}

}  // namespace fettle::core::stepper::step_outputs_test
