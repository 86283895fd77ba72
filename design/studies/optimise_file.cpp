// SPDX-License-Identifier: MIT
#include "fettle/design/studies/optimise_file.hpp"

#include <filesystem>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/reading/design_text.hpp"

namespace fettle::design::studies {

namespace {

HistoryHeader header_of(const reading::DesignFile& file) {
    HistoryHeader header;
    header.design_hash = reading::design_hash(file);
    for (const auto& parameter : file.design.parameters) header.parameters.push_back(parameter.name);
    for (const auto& constraint : file.design.constraints) header.constraints.push_back(constraint.name);
    return header;
}

Errors write_files(const reading::DesignFile& file, const std::string& directory, const OptimiseOutcome& outcome) {
    const std::filesystem::path folder = directory;
    const std::string text = reading::design_text(file, outcome.report.point, directory);
    Errors errors = core::files::write_file_atomically(folder / "design.final.json", text);
    if (!errors.empty()) return errors;
    if (!outcome.final.usable) {
        std::error_code ignored;
        std::filesystem::remove(folder / "trajectory.json", ignored);  // of an earlier run: it would pass for this one's
        return {};
    }
    return core::records::write_trajectory(folder / "trajectory.json", outcome.final.simulation.trajectory, *outcome.final.model,
                                           file.scene_path);
}

}  // namespace

Result<FileOutcome> optimise_file(const reading::DesignFile& file, const problem::DesignProblem& problem, const RunFolder& folder,
                                  OptimiseOptions options) {
    // Before an earlier history is moved away.
    const auto optimiser =
        optimisers::make_optimiser(options.optimiser.empty() ? file.design.optimiser.name : options.optimiser, "optimiser");
    if (!optimiser) return optimiser.errors();
    const HistoryMode mode = folder.resume ? HistoryMode::resume : HistoryMode::fresh;
    Result<History> history = History::open(folder.directory, header_of(file), mode);
    if (!history) return history.errors();
    options.history = &*history;
    Result<OptimiseOutcome> outcome = optimise_design(problem, options);
    if (!outcome) return outcome.errors();
    const Errors errors = write_files(file, folder.directory, *outcome);
    if (!errors.empty()) return errors;
    return FileOutcome{std::move(*outcome), history->kept_as()};
}

}  // namespace fettle::design::studies
