// SPDX-License-Identifier: MIT
/// Can a model be made of this scene? Every fault of its numbers, meshes and masses, with its place; what is odd but usable as warnings.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/body_mass.hpp"

namespace fettle::core::model {

struct SceneCheck {
    Errors errors;
    std::vector<std::string> warnings;
    std::vector<BodyMeasure> measures;         ///< one per body; of a body with errors it means nothing
    std::vector<std::size_t> shapes;           ///< per body the first whose mesh is the same
    std::vector<std::pair<int, int>> ignored;  ///< pairs of bodies (ignored_pairs.hpp)
};

/// By each body's MeshPolicy (scene/scene.hpp): strict asks for perfect solids (solids/mesh_validity.hpp), tolerant takes what does no
/// harm, with warnings (solids/mesh_judgement.hpp), lenient asks only that the mesh can be indexed and has a mass.
/// @param check_meshes  false: meshes are known to be sound.
SceneCheck check_scene(const scene::Scene& scene, bool check_meshes);

}  // namespace fettle::core::model
