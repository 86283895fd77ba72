// SPDX-License-Identifier: MIT
#include "adjoint/stepper/seeded_sweep.hpp"

#include <catch2/catch.hpp>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/adjoint/stepper/sweep_scenes.hpp"

namespace fettle::adjoint::stepper::seeded_sweep_test {

using namespace fettle::tests::adjoint;

using fettle::adjoint::add;
using fettle::adjoint::Seeds;
using fettle::adjoint::zero_seeds;
using fettle::adjoint::stepper::reverse_sweep;
using fettle::adjoint::stepper::seeded_sweep;

TEST_CASE("seeds are swept together, and what they owe to the model is added", "[adjoint][stepper]") {
    const SweepScene scene = pusher();
    core::stepper::SimulationOptions options;
    options.steps = scene.steps;
    options.for_gradient = true;
    const core::stepper::Simulation simulation = core::stepper::simulate(scene.model, options);
    REQUIRE(simulation.report.status == core::stepper::SimulationStatus::ok);
    std::mt19937_64 random(5);

    // One on the whole motion, one on the start alone, one on nothing but the model.
    std::vector<Seeds> seeds(3, zero_seeds(scene.model, scene.steps));
    seeds[0].trajectory_bar = random_seed(scene, random);
    seeds[1].trajectory_bar.pose_bar[0] = random_seed(scene, random).pose_bar[0];
    for (Seeds& seed : seeds) {
        seed.model_bar.gravity_bar = Vector3::Random();
        for (auto& body : seed.model_bar.bodies) body.vertices_bar.setRandom();
    }
    const auto together = seeded_sweep(scene.model, simulation.trajectory, seeds);
    const auto swept =
        reverse_sweep(scene.model, simulation.trajectory, {seeds[0].trajectory_bar, seeds[1].trajectory_bar, seeds[2].trajectory_bar});
    REQUIRE(together);
    REQUIRE(swept);
    REQUIRE(together->size() == 3);
    for (size_t k = 0; k < 3; ++k) {
        ModelGradient sum = seeds[k].model_bar;
        add(sum, (*swept)[k]);
        for (const ParameterKind kind : kinds_of(scene)) {
            const ModelTangent direction = random_direction(scene, kind, random);
            CAPTURE(k, to_string(kind));
            CHECK(pairing(scene, (*together)[k], direction) == Approx(pairing(scene, sum, direction)).epsilon(1e-13).margin(1e-300));
        }
    }
}

}  // namespace fettle::adjoint::stepper::seeded_sweep_test
