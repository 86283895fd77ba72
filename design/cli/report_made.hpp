// SPDX-License-Identifier: MIT
/// What commands with --out leave for people beside what they leave for programs: result.json says by which command, report.html shows it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/design/cli/session.hpp"
#include "fettle/design/report/report_data.hpp"

namespace fettle::design::cli {

/// Writes FOLDER/result.json: `answer`, and `program` (the version) and `command`.
[[nodiscard]] Errors write_result(const std::string& folder, nlohmann::ordered_json answer, const CommonOptions& common);

/// Takes away what an earlier run left in FOLDER of its answer: result.json, report.html.
void forget_answer(const std::string& folder);

/// The same of its motion, before another one is written there: also motion.glb, trajectory.start.json and the tables of the steps.
void forget_motion(const std::string& folder);

/// Writes FOLDER/motion.glb, the animated parts.
[[nodiscard]] Errors write_animation(const std::string& folder, const core::model::Model& model,
                                     const core::stepper::Trajectory& trajectory);

/// Makes FOLDER/report.html, tells of it in `answer` (`report`) and at the end of `told`. A report that cannot be made is a warning: the
/// results are there. Once a stop has been asked for, what takes computing is left out.
/// @param motion  of the folder's trajectory, with its scene's path, if at hand.
void leave_report(const std::string& folder, const CommonOptions& common, Console& console, nlohmann::ordered_json& answer,
                  std::string& told, std::optional<report::Motion> motion = std::nullopt);

}  // namespace fettle::design::cli
