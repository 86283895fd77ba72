// SPDX-License-Identifier: MIT
/// Optimises the design of a file into a folder: optimise_design.hpp with its history, and the final design and trajectory as files.
/// `fettle optimise` is this and its printing.
#pragma once

#include <string>

#include "fettle/design/reading/design_reader.hpp"
#include "fettle/design/studies/optimise_design.hpp"

namespace fettle::design::studies {

struct RunFolder {
    /// For history.jsonl, design.final.json and trajectory.json, which is taken away where no design could be simulated; made if it is not
    /// there.
    std::string directory;
    bool resume = false;  ///< replay an existing history
};

struct FileOutcome {
    OptimiseOutcome outcome;
    std::string history_kept_as;  ///< of an earlier run, if one was moved away
};

/// A killed run, resumed with the same design and options, ends with the same outcome, bit for bit.
/// @param problem  Of file.design.
/// Errors: the optimiser's name, the history (another design's, in use), files that cannot be written.
Result<FileOutcome> optimise_file(const reading::DesignFile& file, const problem::DesignProblem& problem, const RunFolder& folder,
                                  OptimiseOptions options);

}  // namespace fettle::design::studies
