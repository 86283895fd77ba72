// SPDX-License-Identifier: MIT
// What damping of contacts does to a motion: impacts lose energy, rest and sliding are as without it, momentum is kept.
#include "tests/core/stepper/physics_models.hpp"
#include "tests/support/intersection_oracle.hpp"

namespace fettle::core::stepper::damped_contact_physics_test {

using namespace fettle::tests::physics;
using namespace fettle::tests::support;
using core::scene::Integrator;

namespace {

constexpr double side = 0.1;

core::geometry::Mesh cube() { return box_mesh(Vector3::Constant(-side / 2), Vector3::Constant(side / 2)); }

// A cube flat over one triangle of the ground, which its four corners meet; kappa such that it would rest at dhat/2.
core::model::Model falling(double gap, double h, Integrator integrator) {
    core::model::Model model =
        world({make_body("cube", cube(), make_pose(Vector3::Zero(), Vector3(1, 0, side / 2 + gap))), ground_plate()}, h);
    model.integrator = integrator;
    const double load = 0.375 * std::log(4) + 0.5625;  // of one contact at dhat/2, by kappa dhat
    model.kappa = model.bodies[0].moments(3, 3) * gravity / (4 * load * model.dhat);
    return model;
}

// T at which small oscillations about dhat/2 are critically damped (core/contact/contact_damping.hpp).
double critical_time(const core::model::Model& model) { return 0.83 * std::sqrt(model.bodies[0].moments(3, 3) / (4 * model.kappa)); }

double gap_after(const core::stepper::Simulation& run, int step) { return position(run, step).z() - side / 2; }

// Highest gap after the first contact.
double rebound(const core::stepper::Simulation& run) {
    bool touched = false;
    double highest = 0;
    for (int n = 1; n <= count_of(run.outputs); ++n) {
        touched |= run.report.steps[n - 1].contacts > 0 && velocity(run, n).z() > 0;
        if (touched) highest = std::max(highest, gap_after(run, n));
    }
    return highest;
}

}  // namespace

TEST_CASE("a damped contact rebounds less the longer its damping time, and never penetrates", "[physics][contact_damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
        core::model::Model model = falling(0.005, 2e-4, integrator);
        model.kappa *= 30;  // the impact must not go deeper than the time step resolves
        const double critical = critical_time(model);
        std::vector<double> heights;
        for (const double share : {0.0, 0.1, 0.3, 1.0, 3.0}) {
            model.contact_damping_time = share * critical;
            const auto drop = run(model, 400, true);
            CHECK(find_intersections(model, drop.trajectory, 4).intersections.empty());
            heights.push_back(rebound(drop));
        }
        CAPTURE(static_cast<int>(integrator), heights);
        for (std::size_t k = 1; k < heights.size(); ++k) CHECK(heights[k] < heights[k - 1]);
        CHECK(heights.back() < 0.5 * heights[0]);
        if (integrator == Integrator::newmark) CHECK(heights[0] == Approx(0.005).epsilon(0.02));
    }
}

TEST_CASE("implicit Euler gains no energy where contacts are damped", "[physics][contact_damping]") {
    for (const double share : {0.3, 3.0}) {
        core::model::Model model = falling(0.005, 2e-3, Integrator::implicit_euler);
        model.bodies[0].pose_start.rotation = kinematics::rotation(Vector3(0.3, 0.2, 0));
        model.bodies[0].pose_start.position.z() += 0.03;
        model.contact_damping_time = share * critical_time(model);
        const auto fall = run(model, 150, true);
        double before = fall.outputs.front().kinetic_energy + fall.outputs.front().potential_energy + fall.outputs.front().contact_energy;
        const double scale = std::abs(before);
        int touched = 0;
        for (const auto& step : fall.outputs) {
            const double energy = step.kinetic_energy + step.potential_energy + step.contact_energy;
            CHECK(energy <= before + 1e-9 * scale);
            before = energy;
            touched += !step.contacts.empty();
        }
        CHECK(touched > 20);
    }
}

TEST_CASE("small oscillations of a contact are damped as its header says", "[physics][contact_damping]") {
    core::model::Model model = falling(0.502e-3, 5e-5, Integrator::bdf2);
    const double omega = std::sqrt(4 * 3.778 * model.kappa / model.bodies[0].moments(3, 3));
    model.contact_damping_time = critical_time(model);
    const auto decay = run(model, 400, true);
    // (1 + omega t) exp(-omega t) of the 0.002 dhat that it began with; over those, damping varies by 1.4%.
    for (const double phase : {1.0, 2.0, 3.0}) {
        const int step = static_cast<int>(std::lround(phase / omega / model.timestep));
        const double share = (gap_after(decay, step) - 0.5e-3) / 0.002e-3, t = step * model.timestep;
        CHECK(share == Approx((1 + omega * t) * std::exp(-omega * t)).margin(0.01));
    }
}

TEST_CASE("a damped contact comes to rest where one without does", "[physics][contact_damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
        core::model::Model model = falling(0.9e-3, 2e-3, integrator);
        model.contact_damping_time = critical_time(model);
        const auto rest = run(model, 150, true);
        CHECK(gap_after(rest, 150) == Approx(0.5e-3).epsilon(1e-4));
        REQUIRE(rest.outputs.back().contacts.size() == 1);
        const ContactForce& force = rest.outputs.back().contacts[0];
        CHECK(force.force.z() == Approx(model.bodies[0].moments(3, 3) * gravity).epsilon(1e-4));
        CHECK(force.normal == Approx(force.force.z()).epsilon(1e-6));
    }
}

TEST_CASE("a gap that stays is not damped, however fast it slides", "[physics][contact_damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
        core::model::Model model = falling(0.4e-3, 2e-3, integrator);
        model.gravity.setZero();
        prescribe(model.bodies[0], 2);  // it would be pushed off
        set_velocity(model.bodies[0], Vector3(0.8, 0, 0), Vector3::Zero());
        model.contact_damping_time = 10 * critical_time(model);
        const auto slide = run(model, 100, true);
        CHECK(slide.report.steps.back().contacts > 0);
        CHECK(position(slide, 100).x() == Approx(1 + 0.8 * 0.2).epsilon(1e-12));
    }
}

TEST_CASE("damping of contacts keeps linear momentum, and takes energy of the relative motion", "[physics][contact_damping]") {
    for (const Integrator integrator : {Integrator::implicit_euler, Integrator::bdf2, Integrator::newmark}) {
        core::model::Body a = make_body("a", cube(), make_pose(Vector3(0.1, 0.2, 0.3), Vector3(0, 0, 0)));
        core::model::Body b = make_body("b", cube(), make_pose(Vector3(-0.3, 0.1, 0.2), Vector3(0.2, 0.03, -0.025)),
                                        core::scene::BodyType::dynamic_body, 2000);
        set_velocity(a, Vector3(1, 0, 0), Vector3(0, 0, 1));
        core::model::Model model = weightless({a, b}, 5e-4);
        model.kappa = 2.5e4;
        model.integrator = integrator;
        const double kinetic_start = 0.5 * a.moments(3, 3) + 0.5 * inertia(a)(2, 2);
        double kinetic[2];
        for (const bool damped : {false, true}) {
            CAPTURE(static_cast<int>(integrator), damped);
            model.contact_damping_time = damped ? 0.83 * std::sqrt(a.moments(3, 3) / model.kappa) : 0;
            const auto flight = run(model, 400, true);
            int touched = 0;
            for (const auto& step : flight.outputs) {
                touched += !step.contacts.empty();
                CHECK((step.linear_momentum - a.moments(3, 3) * Vector3(1, 0, 0)).norm() < 1e-9 * a.moments(3, 3));
            }
            REQUIRE(touched > 0);
            kinetic[damped] = flight.outputs.back().kinetic_energy;
        }
        CAPTURE(static_cast<int>(integrator), kinetic[0], kinetic[1]);
        CHECK(kinetic[1] < 0.9 * kinetic_start);
        if (integrator == Integrator::implicit_euler) CHECK(kinetic[1] < kinetic[0]);
    }
}

}  // namespace fettle::core::stepper::damped_contact_physics_test
