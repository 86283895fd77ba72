// SPDX-License-Identifier: MIT
/// fettle optimise --starts: runs of the program from many starts, several at once, each in a folder of its own, OUT/start-SEED. A run
/// is the same whatever runs beside it: it is `fettle optimise --seed SEED --out OUT/start-SEED` with one thread or more.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "design/cli/command.hpp"

namespace fettle::design::cli {

struct StartsRequest {
    std::string design, out, optimiser;  ///< as on the command line; `optimiser` empty: the design's
    std::vector<std::uint64_t> seeds;
    bool resume = false, repair = false;
};

/// One run's end.
struct StartResult {
    std::uint64_t seed = 0;
    std::string out;
    std::string status;             ///< of the optimiser; "failed" where the run left no result, "not run" where it never began
    std::string message;            ///< why it failed: the last line of its log
    nlohmann::ordered_json result;  ///< result.json; null if there is none
    int exit_code = 0;
};

/// Runs them all, or, once interrupted, as far as they have come. One whose folder cannot be made is failed; throws std::runtime_error if
/// no process can be started.
std::vector<StartResult> run_starts(const StartsRequest& request, const CommonOptions& common, Console& console);

/// The best one: of those that meet all requirements the one with the least objective (with --repair: the least change), else the one
/// with the least violation; the first of equals. None: no run could evaluate a design.
std::optional<size_t> best_start(const std::vector<StartResult>& starts);

/// How many of the random starts that have ended reach the best design: every requirement met, what is minimised within a thousandth of the
/// least.
struct BestReached {
    int starts = 0, of = 0;
    double least = 0, most = 1;  ///< of the share of all random starts that do, at 95% (Clopper and Pearson)
};
/// Nothing: no start meets every requirement, or none is random.
std::optional<BestReached> best_reached(const std::vector<StartResult>& starts);
/// null: nothing.
nlohmann::ordered_json best_reached_json(const std::vector<StartResult>& starts);

/// The table, as JSON (`starts`: docs/interface.md) and for people, with how many reach the best.
nlohmann::ordered_json starts_json(const std::vector<StartResult>& starts);
std::string starts_text(const std::vector<StartResult>& starts);

}  // namespace fettle::design::cli
