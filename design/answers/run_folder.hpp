// SPDX-License-Identifier: MIT
/// What a run leaves in its folder beside its own files: the answer and the animated parts. The report is made of them (report/).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::design::answers {

/// Writes FOLDER/result.json: `answer`, and `program` (the version) and `command` (that made it).
[[nodiscard]] Errors write_result(const std::string& folder, nlohmann::ordered_json answer, const std::string& command);

/// Takes away what an earlier run left in FOLDER of its answer: result.json, report.html.
void forget_answer(const std::string& folder);

/// The same of its motion, before another one is written there: also motion.glb, trajectory.start.json and the tables of the steps.
void forget_motion(const std::string& folder);

/// Writes FOLDER/motion.glb, the animated parts.
[[nodiscard]] Errors write_animation(const std::string& folder, const core::model::Model& model,
                                     const core::stepper::Trajectory& trajectory);

}  // namespace fettle::design::answers
