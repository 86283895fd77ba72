// SPDX-License-Identifier: MIT
/// The pairs of bodies that a scene's `ignore` names: they pass through each other, and no clearance of theirs is judged unless someone
/// names them.
#pragma once

#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/scene/scene.hpp"

namespace fettle::core::model {

/// Bodies by their places in the scene, the lesser first; sorted, each pair once.
/// Errors: an entry that is not "A:B", one that matches no two bodies (with the nearest name).
base::Result<std::vector<std::pair<int, int>>> ignored_pairs(const scene::Scene& scene);

}  // namespace fettle::core::model
