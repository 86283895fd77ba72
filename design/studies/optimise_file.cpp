// SPDX-License-Identifier: MIT
#include "design/studies/optimise_file.hpp"

#include <filesystem>
#include <utility>

#include "core/records/trajectory_io.hpp"
#include "design/reading/design_text.hpp"

namespace fettle::design::studies {

namespace {

HistoryHeader header_of(const reading::DesignFile& file) {
    HistoryHeader header;
    header.design_hash = reading::design_hash(file);
    for (const auto& parameter : file.design.parameters) header.parameters.push_back(parameter.name);
    for (const auto& constraint : file.design.constraints) header.constraints.push_back(constraint.name);
    return header;
}

Errors write_files(const reading::DesignFile& file, const RunFolder& run, const OptimiseOutcome& outcome) {
    const std::filesystem::path folder = run.directory, trajectory = folder / "trajectory.json";
    core::files::FilesTogether files;
    Errors errors = files.add(folder / "design.final.json", reading::design_text(file, outcome.report.point, run.directory));
    if (!outcome.final.usable) {
        files.take_away(trajectory);  // of an earlier run: it would pass for this one's
    } else if (errors.empty()) {
        errors = core::records::add_trajectory(files, trajectory, outcome.final.runs.front().simulation.trajectory,
                                               *outcome.final.runs.front().model, file.scene_path);
    }
    if (errors.empty() && run.add_files) errors = run.add_files(outcome, files);
    return errors.empty() ? files.take_names() : errors;
}

}  // namespace

Result<FileOutcome> optimise_file(const reading::DesignFile& file, const problem::DesignProblem& problem, const RunFolder& folder,
                                  OptimiseOptions options) {
    // Before an earlier history is moved away.
    const auto optimiser =
        optimisers::make_optimiser(options.optimiser.empty() ? file.design.optimiser.name : options.optimiser, "optimiser");
    if (!optimiser) return optimiser.errors();
    if (const auto scene = reading::scene_from(file, folder.directory); !scene) return scene.errors();
    const LineFileMode mode = folder.resume ? LineFileMode::resume : LineFileMode::fresh;
    Result<History> history = History::open(folder.directory, header_of(file), mode);
    if (!history) return history.errors();
    options.history = &*history;
    bool told = false;
    options.narrate = [&, narrate = options.narrate](const std::string& line) {
        if (!narrate) return;
        narrate(line);
        if (const Errors fault = history->unwritten(); !fault.empty() && !std::exchange(told, true))
            narrate("warning: " + fault.front().where + ": " + fault.front().message + "; until it can, a run that is killed leaves less");
    };
    Result<OptimiseOutcome> outcome = optimise_design(problem, options);
    if (!outcome) return outcome.errors();
    const bool stopped = outcome->report.status == optimisers::OptimiserStatus::interrupted;
    if (folder.measure_finer && outcome->final.usable && !stopped) {
        ResolutionOptions finer;
        finer.should_stop = options.should_stop;
        if (options.narrate) finer.on_variant = [&](const std::string& what) { options.narrate("simulating the result " + what); };
        outcome->finer = measure_finer(file, problem, outcome->report.point, *folder.measure_finer, finer);
    }
    Errors unwritten = history->unwritten();
    const Errors files = write_files(file, folder, *outcome);
    unwritten.insert(unwritten.end(), files.begin(), files.end());
    return FileOutcome{std::move(*outcome), history->kept_as(), std::move(unwritten)};
}

}  // namespace fettle::design::studies
