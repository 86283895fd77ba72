// SPDX-License-Identifier: MIT
/// fettle optimise --starts: runs from many starts, each in the folder OUT/start-SEED: it is `fettle optimise --seed SEED --out
/// OUT/start-SEED`.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "design/cli/optimise_runs.hpp"

namespace fettle::design::cli {

struct StartResult : RunResult {
    std::uint64_t seed = 0;
};

/// In the order of the seeds; as run_together. @param design, out  as on the command line
std::vector<StartResult> run_starts(const std::string& design, const std::string& out, const std::vector<std::uint64_t>& seeds,
                                    const RunSettings& settings, const CommonOptions& common, Console& console);

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
