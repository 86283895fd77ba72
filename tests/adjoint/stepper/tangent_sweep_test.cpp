// SPDX-License-Identifier: MIT
// Whole simulations against central differences: contact active, every kind of parameter, step sizes swept.
#include "adjoint/stepper/tangent_sweep.hpp"

#include <catch2/catch.hpp>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"
#include "tests/support/derivative_check.hpp"

namespace fettle::adjoint::stepper::tangent_sweep_test {

using namespace fettle::tests::adjoint;

namespace {

constexpr int seed_count = 3;
const tests::support::StepSweep sweep{1e-4, 0.3, 9};

core::stepper::Simulation simulation_of(const SweepScene& scene, const core::model::Model& model) {
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    return core::stepper::simulate(model, options);
}

// Objectives of all seeds as a function of the step along `direction`, against `derivative`.
double error_along(const SweepScene& scene, const std::vector<TrajectoryGradient>& seeds, const ModelTangent& direction,
                   const VectorX& derivative) {
    const auto objectives = [&](const VectorX& s) {
        const core::stepper::Simulation simulation = simulation_of(scene, moved(scene, direction, s[0]));
        VectorX out = VectorX::Constant(seed_count, std::numeric_limits<double>::quiet_NaN());
        if (simulation.report.status == core::stepper::SimulationStatus::ok)
            for (int k = 0; k < seed_count; ++k) out[k] = objective(seeds[k], simulation.trajectory);
        return out;
    };
    return tests::support::check_directional(objectives, VectorX::Zero(1), VectorX::Ones(1), derivative, sweep).relative_error;
}

void check_scene(const SweepScene& scene) {
    const core::stepper::Simulation simulation = simulation_of(scene, scene.model);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    std::mt19937_64 random(23);
    std::vector<TrajectoryGradient> seeds;
    for (int s = 0; s < seed_count; ++s) seeds.push_back(random_seed(scene, random));
    const auto gradients = fettle::adjoint::stepper::reverse_sweep(scene.model, simulation.trajectory, seeds);
    REQUIRE(gradients);
    const auto derivative = [&](const ModelTangent& direction) {
        VectorX out(seed_count);
        for (int s = 0; s < seed_count; ++s) out[s] = pairing(scene, (*gradients)[s], direction);
        return out;
    };
    for (const ParameterKind kind : kinds_of(scene)) {
        const ModelTangent direction = random_direction(scene, kind, random);
        CAPTURE(scene.name, to_string(kind), derivative(direction).transpose());
        CHECK(error_along(scene, seeds, direction, derivative(direction)) < 1e-6);
    }
    const ModelTangent along = vertex_gradient_direction(scene, (*gradients)[0]);
    CAPTURE(scene.name, "along the gradient", derivative(along).transpose());
    CHECK(error_along(scene, seeds, along, derivative(along)) < 1e-6);
}

}  // namespace

TEST_CASE("differences: free flight", "[adjoint][stepper]") { check_scene(free_flight()); }
TEST_CASE("differences: boxes on boxes", "[adjoint][stepper][slow]") { check_scene(stack()); }
TEST_CASE("differences: nearly parallel edges", "[adjoint][stepper][slow]") { check_scene(twisted_pair()); }
TEST_CASE("differences: a motor that may tilt", "[adjoint][stepper][slow]") { check_scene(tilting_motor()); }
TEST_CASE("differences: two prescribed rotations of three", "[adjoint][stepper][slow]") { check_scene(double_motor()); }
TEST_CASE("differences: a scripted pusher and fixed coordinates", "[adjoint][stepper][slow]") { check_scene(pusher()); }
TEST_CASE("differences: friction between boxes on boxes", "[adjoint][stepper][slow]") { check_scene(rubbed(stack())); }
TEST_CASE("differences: friction, two prescribed rotations of three", "[adjoint][stepper][slow]") { check_scene(rubbed(double_motor())); }
TEST_CASE("differences: friction, a scripted pusher and fixed coordinates", "[adjoint][stepper]") { check_scene(rubbed(pusher())); }

}  // namespace fettle::adjoint::stepper::tangent_sweep_test
