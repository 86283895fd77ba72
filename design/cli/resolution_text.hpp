// SPDX-License-Identifier: MIT
/// What of an optimised design rests on its facets and its time step, in a few lines for people.
#pragma once

#include <string>

#include "design/answers/optimise_json.hpp"
#include "design/cli/console.hpp"

namespace fettle::design::cli {

/// Empty where it was not measured.
std::string resolution_text(const description::Design& design, const studies::OptimiseOutcome& outcome, const Console& console,
                            const answers::RunFacts& run);

}  // namespace fettle::design::cli
