// SPDX-License-Identifier: MIT
#include "fettle/adjoint/model/build_friction_adjoint.hpp"

#include <cmath>

namespace fettle::adjoint::model {
namespace {

// What a body's own coefficient is, and where its derivative goes.
struct Own {
    double mu;
    double* bar;
};

Own own_coefficient(const core::scene::Scene& scene, std::size_t i, SceneFrictionGradient& out) {
    const core::scene::Body& body = scene.bodies[i];
    if (body.mu) return {*body.mu, &out.bodies[i]};
    const auto listed = scene.friction.materials.find(body.material);
    if (listed != scene.friction.materials.end()) return {listed->second, &out.materials[body.material]};
    return {scene.friction.mu, &out.mu};
}

}  // namespace

SceneFrictionGradient build_friction_adjoint(const core::scene::Scene& scene, const FrictionGradient& gradient) {
    SceneFrictionGradient out;
    out.pairs.assign(scene.friction.pairs.size(), 0);
    out.bodies.assign(scene.bodies.size(), 0);
    for (const auto& [pair, bar] : gradient) {
        const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
        if (const int listed = scene.friction.pair_of(scene.bodies[a].material, scene.bodies[b].material); listed >= 0) {
            out.pairs[static_cast<std::size_t>(listed)] += bar;
            continue;
        }
        const Own of_a = own_coefficient(scene, a, out), of_b = own_coefficient(scene, b, out);
        *of_a.bar += 0.5 * std::sqrt(of_b.mu / of_a.mu) * bar;
        *of_b.bar += 0.5 * std::sqrt(of_a.mu / of_b.mu) * bar;
    }
    return out;
}

}  // namespace fettle::adjoint::model
