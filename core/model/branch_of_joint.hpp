// SPDX-License-Identifier: MIT
/// A joint's `assemble` (scene/mechanism.hpp) -> a branch of the model (constraint/branch.hpp): the joints at the other ends of its two
/// bodies are found, and what goes with each body when it is turned over.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/model/model.hpp"

namespace fettle::core::model {

/// Adds Mechanism::branches, one per joint that has an `assemble`. Contract: the model's joints are those of the scene, and no motors yet.
/// Errors (inconsistent): a joint that is no revolute or prismatic one; a `from` or `to` that does not join one of its bodies, that has no
/// point or slide, or that is not given where there are several or none; `left` where one of the three slides, `ahead` where none does or
/// two do; a leg without length.
base::Errors add_branches(const scene::Scene& scene, Model& model);

/// "the way from `A` over `B` to `D` turns left", "`D` is ahead of `B` along `slide`". @param sign  of constraint::side_of: left and ahead
/// are positive.
std::string words_of_side(const Mechanism& mechanism, const constraint::Branch& branch, double sign);

/// The poses of all bodies at the start.
std::vector<kinematics::Pose> start_poses(const Model& model);

/// A joint's side of a closed linkage, and where that is said.
struct JointSide {
    std::string joint;
    scene::Assemble assemble;
};

/// "left", "right", "ahead", "behind", as files have it.
const char* to_string(scene::AssembleSide side);
/// The other one of the two.
scene::AssembleSide other_side(scene::AssembleSide side);

/// The sides that no joint says and the written poses have decided: pairs of bodies that are joined to each other, and each by one joint
/// more to a body that motors place (the world, bodies that cannot move, those that a joint with a motor of kind `motion` or a fixed joint
/// joins to these, and pairs found before), all three joints revolute, or one of them prismatic, in one plane. As the model stands at its
/// start; a pair at a dead centre there is left out.
std::vector<JointSide> sides_left_open(const Model& model);
/// The same as branches, each on its side.
std::vector<constraint::Branch> branches_left_open(const Model& model);

/// Is the branch on its side? Where a leg has no length it is on none.
bool is_on_side(const Mechanism& mechanism, const constraint::Branch& branch, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::model
