// SPDX-License-Identifier: MIT
/// Does a motion keep to the branches that the scene asks for at its start (constraint/branch.hpp)? A linkage can leave them at a dead
/// centre. And where no joint says a branch: does it pass a dead centre, where nothing decides which way it goes on?
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::core::stepper {

/// One sentence per branch that is on the other side at the end of some step, with the first time; looked at nowhere in between. And one
/// per branch that no joint says (model::branches_left_open) and that comes to where its sides meet: on the other side, within 1e-6 of
/// neither, or back on its own after a step that led across.
std::vector<std::string> branch_warnings(const model::Model& model, const Trajectory& trajectory);

}  // namespace fettle::core::stepper
