// SPDX-License-Identifier: MIT
/// Scene -> Model: validity of the meshes, mass, hierarchies, defaults; refuses a scene whose bodies intersect at the start.
///
///     const auto model = core::setup::build_model(scene);  // read by read_scene, or made in memory
///     for (const auto& error : model.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
///     if (!model) return 3;
///     for (const auto& warning : model->warnings) std::printf("%s\n", warning.c_str());
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/build_mechanism.hpp"
#include "core/model/choose_kappa.hpp"
#include "core/model/choose_proximal_weight.hpp"
#include "core/model/model.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::setup {

struct BuildOptions {
    std::vector<Vector3> reference_points;  ///< one per body, from the first design; empty: centres of mass of this one
    std::optional<double> kappa;            ///< overrides the scene's
    std::optional<double> proximal_weight;  ///< of quasi-static steps, from the first design; default: choose_proximal_weight's
    model::TermScales term_scales;          ///< of joints and springs, from the first design
    std::optional<std::vector<model::FacetSides>> facet_sides;  ///< from the first design; default: choose_facet_sides'
    bool check_meshes = true;                                   ///< by each body's MeshPolicy (a design's trial checks its own)
    bool check_start = true;  ///< refuse bodies that intersect at the start (a clearance report lists them instead)
};

/// Mass of a dynamic body is by its MassKind, exactly (geometry/mass_moments.hpp); its default reference point is its centre of mass, that
/// of other bodies too where they have one by their MassKind, else the middle of their box; or mass and centre are given (Body::inertial).
/// Inertia of wires and points: a straight wire has none about itself. An isotropic second moment is added, the least that makes the
/// inertia about every axis 1e-8 m r^2 (r: the largest |X|, at least dhat), which keeps the Newton matrix definite; a body that has this
/// much already gets nothing. Friction: `friction.mu` by pairs, each of a material or a body's own coefficient; equal coefficients stay
/// exactly as they are. kappa may adapt unless the scene or the options give it. dhat and velocity_tolerance, where the scene does not say:
/// 1e-3 and 1e-2 (per second) of the diagonal of the box of all that is not static at the start, or of everything where all is static.
///
/// @return the model, with `warnings` (meshes: check_scene.hpp; the start: start_check.hpp), or every fault found: `where` names body, mesh
/// and element.
base::Result<model::Model> build_model(const scene::Scene& scene, const BuildOptions& options = {});
/// The same, with the scene's own meshes: large ones need not be copied.
base::Result<model::Model> build_model(scene::Scene&& scene, const BuildOptions& options = {});

}  // namespace fettle::core::setup
