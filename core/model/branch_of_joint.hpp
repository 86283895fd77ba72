// SPDX-License-Identifier: MIT
/// A joint's `assemble` (scene/mechanism.hpp) -> a branch of the model (constraint/branch.hpp): the joints at the other ends of its two
/// bodies are found, and what goes with each body when it is turned over.
#pragma once

#include <string>
#include <vector>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::model {

/// Adds Mechanism::branches, one per joint that has an `assemble`. Contract: the model's joints are those of the scene, and no motors yet.
/// Errors (inconsistent): a joint that is no revolute or prismatic one; a `from` or `to` that does not join one of its bodies, that has no
/// point or slide, or that is not given where there are several or none; `left` where one of the three slides, `ahead` where none does or
/// two do; a leg without length.
base::Errors add_branches(const scene::Scene& scene, Model& model);

/// "the way from `A` over `B` to `D` turns left", "`D` is ahead of `B` along `slide`". @param sign  of constraint::side_of: left and ahead
/// are positive.
std::string words_of_side(const Mechanism& mechanism, const constraint::Branch& branch, double sign);

/// Is the branch on its side? Where a leg has no length it is on none.
bool is_on_side(const Mechanism& mechanism, const constraint::Branch& branch, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::model
