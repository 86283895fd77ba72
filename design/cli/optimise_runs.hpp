// SPDX-License-Identifier: MIT
/// Several runs of `fettle optimise`, each a process of its own in a folder of its own: from many starts (optimise_starts.hpp), of many
/// combinations (optimise_choices.hpp). A run is the same whatever runs beside it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "design/cli/command.hpp"

namespace fettle::design::cli {

struct RunRequest {
    std::string name;                     ///< for people: "seed 3"
    std::string design;                   ///< the file
    std::string out;                      ///< the folder, made if it is not there
    std::vector<std::string> words = {};  ///< of its command line, besides these and those that all have
};

/// What all have of the command line that asked for them.
struct RunSettings {
    std::string optimiser;  ///< empty: the design's
    bool resume = false, repair = false;
    std::string what;  ///< they are, for progress: "starts"
};

/// One run's end.
struct RunResult {
    std::string name, out;
    std::string status;             ///< of the optimiser; "failed" where the run left no result, "not run" where it never began
    std::string message;            ///< why it failed: the last line of its log
    nlohmann::ordered_json result;  ///< result.json; null if there is none
    int exit_code = 0;
};

/// Runs them all, as many at once as there are threads, or, once interrupted, as far as they have come; in the order of the requests. One
/// whose folder cannot be made is failed; throws std::runtime_error if no process can be started.
std::vector<RunResult> run_together(const std::vector<RunRequest>& requests, const RunSettings& settings, const CommonOptions& common,
                                    Console& console);

/// A run that did not begin, and why.
RunResult failed_run(const RunRequest& request, std::string message);

/// The violation of a run's design, then what it minimises (with --repair: the change). Nothing: no design was evaluated.
std::optional<std::pair<double, double>> rank_of(const nlohmann::ordered_json& result);
/// The first of those with the least rank. None: no run could evaluate a design.
template <class Runs>
std::optional<std::size_t> best_run(const Runs& runs) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto rank = rank_of(runs[i].result);
        if (rank && (!best || *rank < *rank_of(runs[*best].result))) best = i;
    }
    return best;
}

/// "seed 3       optimal      objective 6.76       12 evaluations, held by stroke"
std::string line_of(const RunResult& run);
/// What a table has of a run: status, message, objective ..., `out`.
void add_run(nlohmann::ordered_json& row, const RunResult& run);

}  // namespace fettle::design::cli
