// SPDX-License-Identifier: MIT
#include "adjoint/model/build_friction_adjoint.hpp"

#include <catch2/catch.hpp>

#include "adjoint/scene/scene_gradient.hpp"
#include "core/setup/build_model.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::adjoint::model::build_friction_adjoint_test {

namespace {

using core::scene::Scene;

// Two with coefficients of their own, one of them as its material's; two of materials, of which one is in a listed pair; one of neither.
Scene sliding() {
    Scene out;
    out.friction.mu = 0.2;
    out.friction.materials = {{"steel", 0.5}, {"brass", 0.3}};
    out.friction.pairs = {{"brass", "steel", 0.7}};
    const std::array<std::string, 6> materials{"steel", "steel", "brass", "wood", "", "steel"};
    for (std::size_t i = 0; i < materials.size(); ++i) {
        core::scene::Body body;
        body.name = std::to_string(i);
        body.mesh = tests::support::box_mesh({0, 0, 0}, {1, 1, 1});
        body.pose.position.x() = 2 * static_cast<double>(i);
        body.material = materials[i];
        out.bodies.push_back(body);
    }
    out.bodies[0].mu = 0.5;
    out.bodies[3].mu = 0.9;
    return out;
}

double weighted(const Scene& scene, const FrictionGradient& weights) {
    const auto model = core::setup::build_model(scene);
    REQUIRE(model);
    double sum = 0;
    for (const auto& [pair, weight] : weights) sum += weight * friction_coefficient(*model, pair.first, pair.second);
    return sum;
}

}  // namespace

TEST_CASE("the scene's coefficients of friction have the derivatives of what is built from them", "[adjoint][model]") {
    FrictionGradient weights;
    const int count = static_cast<int>(sliding().bodies.size());
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b) weights[{a, b}] = 1 + 0.3 * a - 0.7 * b;
    Scene gradient = scene::zero_scene_gradient(sliding());
    build_friction_adjoint(sliding(), weights, gradient);
    const auto difference = [&](const auto& coefficient) {
        constexpr double e = 1e-5;
        Scene above = sliding(), below = sliding();
        coefficient(above) += e;
        coefficient(below) -= e;
        return (weighted(above, weights) - weighted(below, weights)) / (2 * e);
    };
    CHECK(gradient.friction.mu == Approx(difference([](Scene& s) -> double& { return s.friction.mu; })).epsilon(1e-8));
    for (const char* name : {"steel", "brass"})
        CHECK(gradient.friction.materials.at(name) ==
              Approx(difference([&](Scene& s) -> double& { return s.friction.materials[name]; })).epsilon(1e-8));
    CHECK(gradient.friction.pairs[0].mu == Approx(difference([](Scene& s) -> double& { return s.friction.pairs[0].mu; })).epsilon(1e-8));
    for (const std::size_t i : {0U, 3U})
        CHECK(*gradient.bodies[i].mu == Approx(difference([&](Scene& s) -> double& { return *s.bodies[i].mu; })).epsilon(1e-8));
    CHECK(*gradient.bodies[1].mu == 0);
}

}  // namespace fettle::adjoint::model::build_friction_adjoint_test
