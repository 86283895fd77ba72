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

/// Barrier stiffness [N/m] that needs no tuning: the largest of inertial stiffness m/h^2 scale and what carries every body's
/// weight at half the activation distance. A pure function of masses, h, gravity and dhat.
double choose_kappa(const Model& model);

}  // namespace fettle::core::model
