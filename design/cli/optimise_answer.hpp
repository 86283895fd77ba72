// SPDX-License-Identifier: MIT
/// What `fettle optimise` prints for people (answers/optimise_json.hpp is for programs), and its exit code.
#pragma once

#include <string>
#include <vector>

#include "design/answers/optimise_json.hpp"
#include "design/answers/summary.hpp"
#include "design/cli/console.hpp"
#include "design/cli/finding_files.hpp"

namespace fettle::design::cli {

/// What one reads first: a sentence and a table of at most so many lines.
std::string answer_text(const answers::Summary& summary, const Console& console, std::size_t most_rows = 10);
/// All of it, for --details.
std::string outcome_text(const description::Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                         const answers::RunFacts& run);
/// Which files there are.
std::string written_text(const answers::RunFacts& run);
/// Where to look, and what to type to print it. @param report  the page's file; empty: there is none
std::string next_text(const std::string& report, const std::string& folder);
/// Each requirement as a check.
std::vector<Check> requirement_checks(const description::Design& design, const studies::JudgedDesign& judged, const std::string& file);
/// The same, and that the design is the best near by.
std::vector<Check> outcome_checks(const description::Design& design, const studies::OptimiseOutcome& outcome, const std::string& file);

int exit_code(optimisers::OptimiserStatus status);

}  // namespace fettle::design::cli
