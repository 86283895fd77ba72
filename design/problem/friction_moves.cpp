// SPDX-License-Identifier: MIT
#include "fettle/design/problem/friction_moves.hpp"

#include "fettle/core/base/contract.hpp"

namespace fettle::design::problem {

namespace {

using core::scene::Scene;
using description::Move;
using description::MoveTarget;

int pair_index(const Scene& scene, const Move& move) { return scene.friction.pair_of(move.materials[0], move.materials[1]); }

double coefficient_of(const Move& move, const Scene& scene) {
    switch (move.target) {
        case MoveTarget::body_mu:
            return scene.bodies[static_cast<size_t>(move.body)].mu.value_or(0);
        case MoveTarget::material_mu:
            return scene.friction.materials.at(move.materials[0]);
        case MoveTarget::pair_mu:
            return scene.friction.pairs[static_cast<size_t>(pair_index(scene, move))].mu;
        default:
            return scene.friction.mu;
    }
}

std::string name_of(const Scene& scene, const Move& move) {
    if (move.target == MoveTarget::body_mu) return "body `" + scene.bodies[static_cast<size_t>(move.body)].name + "`";
    if (move.target == MoveTarget::default_mu) return "friction";
    std::string names;
    for (const std::string& material : move.materials) names += (names.empty() ? "`" : ", `") + material + "`";
    return "material " + names;
}

}  // namespace

std::string friction_misfit(const Scene& scene, const Move& move) {
    switch (move.target) {
        case MoveTarget::body_mu:
            return move.body >= 0 && static_cast<size_t>(move.body) < scene.bodies.size() ? "" : "there is no body of that number";
        case MoveTarget::material_mu:
            if (move.materials.size() != 1) return "one material is wanted";
            return scene.friction.materials.count(move.materials[0]) > 0 ? "" : name_of(scene, move) + " has no `mu` in the scene";
        case MoveTarget::pair_mu:
            if (move.materials.size() != 2) return "two materials are wanted";
            return pair_index(scene, move) >= 0 ? "" : name_of(scene, move) + " are no pair in the scene's `friction`";
        default:
            return "";
    }
}

void set_coefficient(const Move& move, double value, Scene& scene) {
    switch (move.target) {
        case MoveTarget::body_mu:
            scene.bodies[static_cast<size_t>(move.body)].mu = value;
            break;
        case MoveTarget::material_mu:
            scene.friction.materials.at(move.materials[0]) = value;
            break;
        case MoveTarget::pair_mu:
            scene.friction.pairs[static_cast<size_t>(pair_index(scene, move))].mu = value;
            break;
        default:
            FETTLE_ASSERT(move.target == MoveTarget::default_mu, "a coefficient of friction");
            scene.friction.mu = value;
    }
}

double coefficient_gradient(const Move& move, const Scene& scene, const adjoint::model::SceneFrictionGradient& gradient) {
    switch (move.target) {
        case MoveTarget::body_mu:
            return gradient.bodies[static_cast<size_t>(move.body)];
        case MoveTarget::material_mu: {
            const auto found = gradient.materials.find(move.materials[0]);
            return found == gradient.materials.end() ? 0 : found->second;
        }
        case MoveTarget::pair_mu:
            return gradient.pairs[static_cast<size_t>(pair_index(scene, move))];
        default:
            return gradient.mu;
    }
}

Errors coefficient_moved_badly(const Scene& scene, const Move& move) {
    if (coefficient_of(move, scene) > 0) return {};
    return {{ErrorCode::out_of_range, name_of(scene, move), "its coefficient of friction must be greater than 0 for a derivative"}};
}

}  // namespace fettle::design::problem
