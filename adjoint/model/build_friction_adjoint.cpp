// SPDX-License-Identifier: MIT
#include "adjoint/model/build_friction_adjoint.hpp"

#include <cmath>

namespace fettle::adjoint::model {
namespace {

// What a body's own coefficient is, and where its derivative goes.
struct Own {
    double mu;
    double* bar;
};

Own own_coefficient(const core::scene::Scene& scene, std::size_t i, core::scene::Scene& bar) {
    const core::scene::Body& body = scene.bodies[i];
    if (body.mu) return {*body.mu, &*bar.bodies[i].mu};
    const auto listed = scene.friction.materials.find(body.material);
    if (listed != scene.friction.materials.end()) return {listed->second, &bar.friction.materials.at(body.material)};
    return {scene.friction.mu, &bar.friction.mu};
}

}  // namespace

void build_friction_adjoint(const core::scene::Scene& scene, const FrictionGradient& gradient, core::scene::Scene& bar) {
    for (const auto& [pair, of_pair] : gradient) {
        const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
        if (const int listed = scene.friction.pair_of(scene.bodies[a].material, scene.bodies[b].material); listed >= 0) {
            bar.friction.pairs[listed].mu += of_pair;
            continue;
        }
        const Own of_a = own_coefficient(scene, a, bar), of_b = own_coefficient(scene, b, bar);
        *of_a.bar += 0.5 * std::sqrt(of_b.mu / of_a.mu) * of_pair;
        *of_b.bar += 0.5 * std::sqrt(of_a.mu / of_b.mu) * of_pair;
    }
}

}  // namespace fettle::adjoint::model
