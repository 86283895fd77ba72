// SPDX-License-Identifier: MIT
/// Optimises the design of a file into a folder: optimise_design.hpp with its history, and the final design and trajectory as files.
/// `fettle optimise` is this and its printing.
///
///     const auto file = design::reading::read_design("hinge.design.json");
///     const auto problem = file ? design::problem::DesignProblem::create(file->design) : file.errors();
///     if (!problem) return 3;
///     const auto done = design::studies::optimise_file(*file, *problem, {.directory = "out", .resume = true}, {});
///     if (!done) return 3;
///     std::printf("%s: out/design.final.json\n", to_string(done->outcome.report.status));
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/files/atomic_file.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_design.hpp"

namespace fettle::design::studies {

struct RunFolder {
    /// For history.jsonl, design.final.json and trajectory.json, which is taken away where no design could be simulated; made if it is not
    /// there.
    std::string directory;
    bool resume = false;  ///< replay an existing history
    /// As the file was read. Given: the design that is found is simulated twice more, finer (OptimiseOutcome::finer), unless the run was
    /// interrupted.
    std::optional<reading::DesignReadOptions> measure_finer = {};
    /// Optional: what else takes its place with design.final.json and trajectory.json. @return why it cannot be written
    std::function<Errors(const OptimiseOutcome&, core::files::FilesTogether&)> add_files = {};
};

struct FileOutcome {
    OptimiseOutcome outcome;
    std::string history_kept_as;  ///< of an earlier run, if one was moved away
    /// What could not be written (file_unwritable): of the history, or of the files, all of which are then as they were before.
    Errors unwritten;
};

/// A killed run, resumed with the same design and options, ends with the same outcome, bit for bit.
/// @param problem  The problem of file.design; to begin on the sides of the seed, both of file_of_seed (starting_sides.hpp).
/// Errors: the optimiser's name, the history (another design's, in use, not to be written from the start).
Result<FileOutcome> optimise_file(const reading::DesignFile& file, const problem::DesignProblem& problem, const RunFolder& folder,
                                  OptimiseOptions options);

}  // namespace fettle::design::studies
