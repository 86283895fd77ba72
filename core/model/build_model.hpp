// SPDX-License-Identifier: MIT
/// Scene -> Model: validity of the meshes, mass, hierarchies, defaults; refuses a scene whose bodies intersect at the start.
#pragma once

#include <optional>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/scene/scene.hpp"

namespace fettle::core::model {

struct BuildOptions {
    std::vector<Vector3> reference_points;  ///< one per body, from the first design; empty: centres of mass of this one
    std::optional<double> kappa;            ///< overrides the scene's
    bool check_meshes = true;               ///< closed, oriented, no self-intersection (a design's trial checks its own)
};

/// @return the model, or every fault found: `where` names body, mesh and element.
Result<Model> build_model(const scene::Scene& scene, const BuildOptions& options = {});

/// Barrier stiffness [N/m] that needs no tuning: over the dynamic bodies, the largest of
///   0.1 m / h^2           inertia: a contact that stops the body within a step or so stays well conditioned beside m / h^2, and
///   4 m |g + f/m| / dhat  load: one contact at half the activation distance pushes with about 1.08 kappa dhat, so that the load is carried
///                         with room to spare. (Energy of a contact: kappa b(D) / (4 (dmin + dhat)^2), b = -(D - Dhat)^2 ln(D / Dhat).)
/// 1 if there is no dynamic body: then nothing touches. A pure function of masses, forces, h, gravity and dhat.
double choose_kappa(const Model& model);

/// Fills radius (rounded up), edge_length_squared, areas and hierarchy from the body's mesh.
void complete_geometry(Body& body);

}  // namespace fettle::core::model
