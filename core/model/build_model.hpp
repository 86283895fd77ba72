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
    bool check_start = true;                ///< refuse bodies that intersect at the start (a clearance report tells of them instead)
};

/// Mass of a dynamic body is by its MassKind, exactly (geometry/mass_moments.hpp); its default reference point is its centre of mass, that
/// of other bodies too where they have one by their MassKind, else the middle of their box. Inertia of wires and points: a straight wire
/// has none about itself. An isotropic second moment is added, the least that makes the inertia about every axis 1e-8 m r^2 (r: the largest
/// |X|, at least dhat), which keeps the Newton matrix definite; a body that has this much already gets nothing. Friction: `friction.mu` by
/// pairs of what bodies rub with (material, own coefficient); equal coefficients stay exactly what they are. kappa may adapt unless the
/// scene or the options give it.
///
/// @return the model, or every fault found: `where` names body, mesh and element.
Result<Model> build_model(const scene::Scene& scene, const BuildOptions& options = {});

/// Barrier stiffness [N/m] that needs no tuning: over the dynamic bodies, the largest of
///   0.1 m / h^2           inertia: a contact that stops the body within a step or so stays well conditioned beside m / h^2, and
///   4 m |g + f/m| / dhat  load: one contact at half the activation distance pushes with about 1.08 kappa dhat, so that the load is carried
///                         with room to spare. (Energy of a contact: kappa b(D) / (4 (dmin + dhat)^2), b = -(D - Dhat)^2 ln(D / Dhat).)
/// Area-weighted: per area, a fortieth of each body's surface [N/m^3].
/// 1 if there is no dynamic body: then nothing touches. A pure function of masses, forces, h, gravity and dhat.
double choose_kappa(const Model& model);

/// Fills radius (rounded up), edge_length_squared, areas and hierarchy from the body's mesh.
void complete_geometry(Body& body);

/// The same for all; bodies whose meshes have the same shape share one hierarchy.
void complete_geometry(std::vector<Body>& bodies);

}  // namespace fettle::core::model
