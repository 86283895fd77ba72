// SPDX-License-Identifier: MIT
/// What a command has found, for those who show it beside a project: JUnit XML (the tests of a CI), SARIF 2.1.0 (code scanning), Markdown
/// (a job's summary), and lines that GitHub Actions puts beside the files. Their verdict is that of the exit code: undecided is no pass.
/// In a certificate that is accepted, exit code 0, pairs whose solids it does not prove to be apart are undecided all the same.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/clearance/pair_clearance.hpp"

namespace fettle::design::cli {

enum class CheckOutcome {
    passed,
    remarked,   ///< passed, with something that people should know
    failed,     ///< exit code 1
    undecided,  ///< exit code 2
    fault       ///< could not be looked at: exit codes 3 and 4
};

struct Check {
    std::string name;  ///< "crank:rod", "stroke piston"
    CheckOutcome outcome = CheckOutcome::passed;
    std::string rule;     ///< what kind of finding: "below threshold"; no spaces are kept in SARIF
    std::string message;  ///< with numbers and units
    std::string file;     ///< that it is about; empty: none
};

/// The outcome for a pair of bodies; "contact" is not judged.
CheckOutcome to_check(core::clearance::PairStatus status);
int exit_code(core::clearance::PairStatus status);

/// That not every pair was judged, or not to the end, and why.
Check not_judged(const std::string& why, const std::string& file);

/// Where it goes; empty: nowhere.
struct FindingFiles {
    std::string junit, sarif, markdown;
    bool annotations = false;    ///< lines for GitHub Actions on stderr
    std::string summary_before;  ///< where Markdown goes to GitHub's job summary: what others have written there

    bool wanted() const { return annotations || !(junit.empty() && sarif.empty() && markdown.empty()); }
};

/// All of a command's.
struct Checks {
    std::string command;  ///< "clearance"
    int exit_code = 0;
    CheckOutcome verdict = CheckOutcome::passed;  ///< that it stands for
    std::vector<Check> list;
    std::string about = {};  ///< the file that the command is about: where findings are that have no file of their own
};

std::string junit_xml(const Checks& checks);
/// Findings alone, each with a file (code scanning refuses all where one has none: `about`, else the working directory); those below the
/// working directory by their way from there, as code scanning wants them.
std::string sarif_json(const Checks& checks);
std::string markdown_text(const Checks& checks);
/// "::error file=...,title=...::..." for each finding.
std::string annotation_lines(const Checks& checks);

/// Can they be written? An earlier run's are taken away: what ends before it has found anything must leave no pass behind. `files` keeps
/// those that can be. Contract: none of them is read by the command (named_files.hpp).
[[nodiscard]] Errors prepare_finding_files(FindingFiles& files);

/// Writes the files that are asked for; can be called again. GitHub's job summary, where Markdown is to go there, is added to.
[[nodiscard]] Errors write_finding_files(const FindingFiles& files, const Checks& checks);

}  // namespace fettle::design::cli
