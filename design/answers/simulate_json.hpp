// SPDX-License-Identifier: MIT
/// What `simulate` answers, but for the proof of its path (clearance/report_json.hpp). Keys: docs/interface.md. SI.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/model/model.hpp"
#include "core/stepper/balance.hpp"
#include "core/stepper/simulation.hpp"

namespace fettle::design::answers {

/// How it went: {steps, newton_iterations, wall_seconds}
nlohmann::ordered_json run_json(const core::stepper::Simulation& simulation);

/// Adds to an answer where the simulation ended: `bodies`, and of a mechanism `joints`, `joint_gap`, `path_joint_gap`: forces at the end,
/// how far joints parted at most. (A value that is returned would be copied into the answer, with thousands of bodies.)
void add_end(const core::model::Model& model, const core::stepper::Simulation& simulation, nlohmann::ordered_json& answer);

nlohmann::ordered_json balance_json(const core::stepper::Balance& balance);

}  // namespace fettle::design::answers
