// SPDX-License-Identifier: MIT
// Resultant forces of contact: as the steps report them, the whole of what stands still, and derivatives backwards, forwards and by
// differences.
#include "adjoint/stepper/contact_forces.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "adjoint/stepper/seeded_sweep.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::adjoint::stepper::contact_forces_test {

using namespace fettle::tests::adjoint;
using core::scene::Integrator;

namespace {

core::stepper::Simulation simulation_of(const SweepScene& scene, const core::model::Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    options.outputs = true;
    return core::stepper::simulate(model, options);
}

// The stack, with what a contact can have.
std::vector<SweepScene> scenes() {
    std::vector<SweepScene> out{stack()};
    out.push_back(stack());
    out.back().name += ", BDF2, damped contact";
    out.back().model.integrator = Integrator::bdf2;
    out.back().model.contact_damping_time = 2e-3;
    out.push_back(stack());
    out.back().name += ", Newmark, area-weighted, damped contact";
    out.back().model.integrator = Integrator::newmark;
    out.back().model.timestep = 0.004;
    out.back().model.contact_damping_time = 2e-3;
    out.back().model.area_weighted = true;
    out.back().model.kappa *= 1e3;
    out.push_back(rubbed(stack()));
    out.push_back(rubbed(stack()));
    out.back().name += ", BDF2, damped contact, dmin";
    out.back().model.integrator = Integrator::bdf2;
    out.back().model.contact_damping_time = 2e-3;
    out.back().model.dmin = 0.1 * out.back().model.dhat;
    out.push_back(rubbed(stack()));
    out.back().name += ", Newmark, one round, area-weighted";
    out.back().model.integrator = Integrator::newmark;
    out.back().model.timestep = 0.004;
    out.back().model.friction.rounds = 1;
    out.back().model.area_weighted = true;
    out.back().model.kappa *= 1e3;
    for (SweepScene& scene : out) scene.steps = 12;
    return out;
}

std::vector<Vector3> random_weights(int steps, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Vector3> out;
    for (int t = 0; t < steps; ++t) out.push_back(Vector3::NullaryExpr([&] { return unit(random); }));
    return out;
}

double weighted(const std::vector<Vector3>& weights, const std::vector<Vector3>& forces) {
    double sum = 0;
    for (std::size_t t = 0; t < weights.size(); ++t) sum += weights[t].dot(forces[t]);
    return sum;
}

// The least relative error over steps of differences, each extrapolated, down to what is small enough. Friction has kinks, forces have
// noise.
template <class At>
double difference_error(const At& at, double derivative, double enough) {
    double least = INFINITY;
    for (const double s : {1e-5, 3e-5, 1e-4, 1e-3, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8}) {
        if (least < enough) break;
        const double coarse = (at(s) - at(-s)) / (2 * s), fine = (at(s / 2) - at(-s / 2)) / s;
        least = std::min(least, std::abs((4 * fine - coarse) / 3 - derivative) / std::abs(derivative));
    }
    return least;
}

const ContactForceOf asked[] = {
    {1, {}, {}}, {2, 1, {}}, {0, 1, {}}, {1, {}, Vector3(0.02, -0.03, 0.01)}, {2, 1, Vector3(0, 0.04, 0)}, {0, 1, Vector3(0.1, 0, 0)}};

}  // namespace

TEST_CASE("forces of contact are those that the steps report", "[adjoint][stepper]") {
    for (const SweepScene& scene : scenes()) {
        const core::stepper::Simulation done = simulation_of(scene, scene.model);
        CAPTURE(scene.name, done.report.message);
        REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
        double largest = 0;
        for (const ContactForceOf& of : asked) {
            // Friction acts on each of two bodies at a point of its own; the reported torque is that on the first.
            if (of.about && of.body > 0 && scene.model.friction.mu.maxCoeff() > 0) continue;
            const std::vector<Vector3> forces = contact_forces(scene.model, done.trajectory, of);
            for (std::size_t t = 0; t < forces.size(); ++t) {
                Vector3 reported = Vector3::Zero();
                for (const core::energy::ContactForce& f : done.outputs[t].contacts) {
                    if (of.other && f.a != *of.other && f.b != *of.other) continue;
                    if (f.a != of.body && f.b != of.body) continue;
                    const double sign = f.a == of.body ? 1 : -1;
                    reported += sign * (of.about ? f.torque : f.force);
                    if (!of.about) continue;
                    const core::kinematics::Pose& pose = done.trajectory.poses[t + 1][of.body];
                    reported -= sign * world_position(pose, *of.about).cross(f.force);
                }
                CHECK((forces[t] - reported).norm() <= 1e-9 * (1 + reported.norm()));
                largest = std::max(largest, reported.norm());
            }
        }
        CHECK(largest > 1);
    }
}

TEST_CASE("forces of contact: backwards, forwards and differences agree", "[adjoint][stepper][slow]") {
    for (const SweepScene& scene : scenes()) {
        const core::stepper::Simulation done = simulation_of(scene, scene.model);
        CAPTURE(scene.name);
        REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
        std::mt19937_64 random(3);
        for (const ContactForceOf& of : asked) {
            const std::vector<Vector3> weights = random_weights(scene.steps, random);
            Seeds seeds = zero_seeds(scene.model, scene.steps);
            add_contact_force_seeds(scene.model, done.trajectory, of, weights, seeds);
            const auto gradients = seeded_sweep(scene.model, done.trajectory, {seeds});
            CAPTURE(gradients ? "" : gradients.errors()[0].message);
            REQUIRE(gradients);
            for (const ParameterKind kind : kinds_of(scene)) {
                const ModelTangent direction = random_direction(scene, kind, random);
                const double backwards = pairing(scene, (*gradients)[0], direction);
                double forwards = backwards;  // friction's is not known forwards
                if (scene.model.friction.mu.maxCoeff() == 0) {
                    const auto tangents = tangent_sweep(scene.model, done.trajectory, direction);
                    REQUIRE(tangents);
                    forwards = weighted(weights, contact_force_tangents(scene.model, done.trajectory, of, {direction, *tangents}));
                }
                CAPTURE(of.body, to_string(kind), backwards, forwards);
                CHECK(std::abs(backwards - forwards) <= 1e-9 * std::abs(forwards));
                if (forwards == 0) continue;
                const auto at = [&](double step) {
                    const core::model::Model there = moved(scene, direction, step);
                    return weighted(weights, contact_forces(there, simulation_of(scene, there).trajectory, of));
                };
                const double error = difference_error(at, forwards, 1e-6);
                CAPTURE(error);
                CHECK(error < 1e-6);
            }
        }
    }
}

namespace {

// A box lies on a plate; by equilibria.
SweepScene box_at_rest() {
    SweepScene scene{"box", {}, 3};
    scene.model.gravity = {0, 0, -9.81};
    scene.model.timestep = 0.01;
    scene.model.dhat = 1e-3;
    scene.model.kappa = 1e5;
    scene.model.velocity_tolerance = 1e-6;
    scene.model.integrator = Integrator::quasi_static;
    scene.model.bodies = {tests::support::ground_plate(),
                          tests::support::make_body("box", tests::support::box_mesh({-0.05, -0.04, -0.03}, {0.05, 0.04, 0.05}),
                                                    tests::support::make_pose({0, 0, 0.2}, {0, 0, 0.0305}))};
    scene.model.proximal_weight = core::model::choose_proximal_weight(scene.model);
    return scene;
}

}  // namespace

TEST_CASE("a box at rest is carried by its weight, and more by what presses it", "[adjoint][stepper]") {
    const SweepScene scene = box_at_rest();
    const core::stepper::Simulation done = simulation_of(scene, scene.model);
    CAPTURE(done.report.message);
    REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
    const double mass = scene.model.bodies[1].moments(3, 3);
    CHECK(contact_forces(scene.model, done.trajectory, {1, 0}).back().z() == Approx(mass * 9.81).epsilon(1e-6));
    Seeds seeds = zero_seeds(scene.model, scene.steps);
    std::vector<Vector3> weights(3, Vector3::Zero());
    weights.back() = Vector3::UnitZ();
    add_contact_force_seeds(scene.model, done.trajectory, {1, 0}, weights, seeds);
    const auto gradients = seeded_sweep(scene.model, done.trajectory, {seeds});
    REQUIRE(gradients);
    CHECK((*gradients)[0].bodies[1].force_bar.z() == Approx(-1).epsilon(1e-5));
    CHECK((*gradients)[0].gravity_bar.z() == Approx(-mass).epsilon(1e-5));
    CHECK((*gradients)[0].bodies[1].density_bar == Approx(mass * 9.81 / 1000).epsilon(1e-5));
}

// What a scale between the two would read, whichever way they lean on one another.
TEST_CASE("a box that is pushed within friction is held by its weight and the push", "[adjoint][stepper]") {
    SweepScene scene = box_at_rest();
    scene.model.friction.mu.setConstant(0.5);
    scene.model.friction.eps_v = 1e-3;
    scene.model.friction.rounds = 50;
    const double mass = scene.model.bodies[1].moments(3, 3), push = 0.2 * mass * 9.81;
    scene.model.bodies[1].force = {push, 0, 0};
    const core::stepper::Simulation done = simulation_of(scene, scene.model);
    CAPTURE(done.report.message);
    REQUIRE(done.report.status == core::stepper::SimulationStatus::ok);
    const Vector3 force = contact_forces(scene.model, done.trajectory, {1, 0}).back();
    CHECK(force.x() == Approx(-push).epsilon(1e-6));
    CHECK(force.z() == Approx(mass * 9.81).epsilon(1e-6));
    for (const Vector3& along : {Vector3(Vector3::UnitX()), Vector3(Vector3::UnitZ())}) {
        Seeds seeds = zero_seeds(scene.model, scene.steps);
        std::vector<Vector3> weights(3, Vector3::Zero());
        weights.back() = along;
        add_contact_force_seeds(scene.model, done.trajectory, {1, 0}, weights, seeds);
        const auto gradients = seeded_sweep(scene.model, done.trajectory, {seeds});
        CAPTURE(gradients ? "" : gradients.errors()[0].message);
        REQUIRE(gradients);
        CHECK((*gradients)[0].bodies[1].force_bar.dot(along) == Approx(-1).epsilon(1e-5));
        CHECK((*gradients)[0].gravity_bar.dot(along) == Approx(-mass).epsilon(1e-5));
        double of_mu = 0;
        for (const auto& [pair, bar] : (*gradients)[0].friction_bar) of_mu += bar;
        CHECK(std::abs(of_mu) < 1e-5 * push);
    }
}

}  // namespace fettle::adjoint::stepper::contact_forces_test
