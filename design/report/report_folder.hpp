// SPDX-License-Identifier: MIT
/// The report of a folder of results: DIR/report.html, made from the files that `optimise`, `simulate` or `clearance` wrote there with
/// --out; by the program that has just done so from the values themselves (AtHand), as far as it has them.
///   result.json        what was answered
///   trajectory.json    bodies and motion
///   design.final.json, history.jsonl      of an optimisation
///   steps.csv, contacts.csv, drives.csv, joints.csv     forces and energies
/// The page links to other files that are there. For an optimisation the motion of the design before (trajectory.start.json) and these
/// tables are computed where they are missing, in two simulations, and kept there.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/report/report_data.hpp"
#include "design/studies/optimise_design.hpp"

namespace fettle::design::report {

/// The note on a file of lines that a run was adding to when it ended.
inline constexpr const char* cut_off = "The last line of the file was cut off, as a run that is killed leaves it: it was left out.";

/// A design that has been optimised.
struct FinalDesign {
    const reading::DesignFile* file = nullptr;
    const problem::DesignProblem* problem = nullptr;  ///< of file->design
    VectorX values;                                   ///< of the parameters at the end
};

/// What of the folder need not be read.
struct AtHand {
    std::optional<nlohmann::ordered_json> answer = {};  ///< that of result.json
    std::optional<Motion> motion = {};                  ///< of the folder's trajectory, with its scene's path
    std::optional<FinalDesign> design = {};             ///< of design.final.json
    std::optional<StepCurves> steps = {};               ///< of a simulation's tables
};

/// The values of an optimisation that has just ended; both must outlive it.
AtHand at_hand(const reading::DesignFile& file, const problem::DesignProblem& problem, const studies::OptimiseOutcome& outcome);

struct ReportOptions {
    std::string out;                                          ///< file; empty: report.html in the folder
    std::vector<std::string> mesh_dirs;                       ///< also looked in for meshes
    reading::Programs programs = reading::Programs::refused;  ///< may parts be made anew by the programs that the scene names?
    AtHand at_hand = {};
    std::function<bool()> should_stop = [] { return false; };  ///< asked often; true: what takes computing is left out
    std::function<void(const std::string&)> tell = {};         ///< optional: what of the input was left out, as the page says it too
};

/// @return the path of the report. Errors: no result.json, one of another kind, files that cannot be read or written, or a report.html of
/// another program in the folder (one that `out` names is replaced).
Result<std::string> write_report(const std::string& folder, ReportOptions options = {});

}  // namespace fettle::design::report
