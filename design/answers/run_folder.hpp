// SPDX-License-Identifier: MIT
/// What a run leaves in its folder beside its own files: the answer and the animated parts. The report is made of them (report/).
/// All of it takes its place together, the answer last (core/files/atomic_file.hpp).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/files/atomic_file.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/problem/design_problem.hpp"

namespace fettle::design::answers {

/// The answer as result.json has it: with `program` (the version) and `command` (that made it), and null for what is no number.
nlohmann::ordered_json result_json(nlohmann::ordered_json answer, const std::string& command);

/// FOLDER/result.json: `answer`, and `program` (the version) and `command` (that made it). The last file of the set.
[[nodiscard]] Errors add_result(core::files::FilesTogether& files, const std::string& folder, nlohmann::ordered_json answer,
                                const std::string& command);

/// Takes away what an earlier run left in FOLDER of its answer: report.html, and result.json if no other is added.
void replace_answer(core::files::FilesTogether& files, const std::string& folder);

/// The name of the file with the trajectory of a scenario that is not the first: trajectory.scenario.NAME.json, where %2F and the like
/// stand for what no file's name may have.
std::string scenario_trajectory(const std::string& scenario);

/// The same of its motion, where another one takes its place: also motion.glb, trajectory.start.json, trajectories of scenarios, and the
/// tables of the steps.
void replace_motion(core::files::FilesTogether& files, const std::string& folder);

/// What an optimisation leaves beside its design and trajectory: FOLDER/result.json, and of a design that could be simulated motion.glb.
[[nodiscard]] Errors add_outcome(core::files::FilesTogether& files, const std::string& folder, const problem::DesignEvaluation& final,
                                 const nlohmann::ordered_json& answer, const std::string& command);

/// FOLDER/motion.glb, the animated parts.
[[nodiscard]] Errors add_animation(core::files::FilesTogether& files, const std::string& folder, const core::model::Model& model,
                                   const core::stepper::Trajectory& trajectory);

/// Is there a file of this name that another program wrote? It is not to be replaced. By its beginning or its keys, which are those that
/// its name promises: result.json, design.final.json, a trajectory (any other JSON), motion.glb, a table of steps, a report (anything
/// else). Errors: inconsistent, with what to do.
[[nodiscard]] Errors others_file(const std::filesystem::path& file);

/// The same of all that a run writes or takes away in FOLDER: report, answer, trajectories, animated parts, tables; and of `more` names.
[[nodiscard]] Errors others_files(const std::filesystem::path& folder, const std::vector<std::string>& more = {});

}  // namespace fettle::design::answers
