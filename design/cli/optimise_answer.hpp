// SPDX-License-Identifier: MIT
/// What `fettle optimise` tells people (answers/optimise_json.hpp is for programs), and its exit code.
#pragma once

#include <string>

#include "fettle/design/answers/optimise_json.hpp"
#include "fettle/design/cli/console.hpp"

namespace fettle::design::cli {

std::string outcome_text(const description::Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                         const answers::RunFacts& run);
int exit_code(optimisers::OptimiserStatus status);

}  // namespace fettle::design::cli
