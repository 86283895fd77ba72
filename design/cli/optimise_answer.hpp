// SPDX-License-Identifier: MIT
/// What `fettle optimise` prints for people (answers/optimise_json.hpp is for programs), and its exit code.
#pragma once

#include <string>
#include <vector>

#include "fettle/design/answers/optimise_json.hpp"
#include "fettle/design/cli/console.hpp"
#include "fettle/design/cli/finding_files.hpp"

namespace fettle::design::cli {

std::string outcome_text(const description::Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                         const answers::RunFacts& run);
/// Which files there are.
std::string written_text(const answers::RunFacts& run);
/// Each requirement as a check, and that the design is the best near by.
std::vector<Check> outcome_checks(const description::Design& design, const studies::OptimiseOutcome& outcome, const std::string& file);

int exit_code(optimisers::OptimiserStatus status);

}  // namespace fettle::design::cli
