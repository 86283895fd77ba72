// SPDX-License-Identifier: MIT
#include "fettle/adjoint/model/build_friction_adjoint.hpp"

#include <algorithm>
#include <cmath>

namespace fettle::adjoint::model {
namespace {

// Of the pair of materials that says it; -1: none does.
int listed_pair(const core::scene::Scene& scene, const core::scene::Body& a, const core::scene::Body& b) {
    if (a.material.empty() || b.material.empty()) return -1;
    const auto& pairs = scene.friction.pairs;
    const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const core::scene::Friction::Pair& pair) {
        return std::minmax(pair.material_a, pair.material_b) == std::minmax(a.material, b.material);
    });
    return found == pairs.end() ? -1 : static_cast<int>(found - pairs.begin());
}

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
        if (const int listed = listed_pair(scene, scene.bodies[a], scene.bodies[b]); listed >= 0) {
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
