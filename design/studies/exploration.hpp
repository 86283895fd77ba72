// SPDX-License-Identifier: MIT
/// Exploring a design space: many designs evaluated, or the optimiser run from many starts, several at once. Each is a job of its own,
/// whose result is one line of a file (exploration_file.hpp) and has the same numbers, bit for bit, whoever computes it.
///
///     Result<std::vector<ExplorationJob>> jobs = jobs_of(problem, {.samples = 200});
///     Result<ExplorationFile> file = ExplorationFile::open("sweep.jsonl", header_of(problem.design(), design_hash));
///     Explored found = explore(problem, *jobs, *file, {});
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/problem/design_problem.hpp"
#include "design/studies/exploration_file.hpp"

namespace fettle::design::studies {

/// One design to evaluate, or one run of the optimiser.
struct ExplorationJob {
    enum class Kind { evaluate, optimise };
    Kind kind = Kind::evaluate;
    VectorX point = {};      ///< of `evaluate`: the parameters' values, SI
    std::uint64_t seed = 0;  ///< of `optimise`: where it begins (start_of_seed)
    /// The same for the same job, by the bits of its numbers.
    std::string key() const;
};
const char* to_string(ExplorationJob::Kind kind);

/// A parameter that takes several values.
struct SweptParameter {
    std::string name;
    int count = 0;        ///< so many, evenly between the parameter's bounds; where `values` has none
    VectorX values = {};  ///< SI
    std::string where;    ///< for messages: where the user asked for it
};

/// "NAME=COUNT", or "NAME=LOW:HIGH:COUNT" in the parameter's own unit. Errors: another form (parse), a count below 1 (out_of_range), an
/// end that is not finite (not_finite) or far outside the bounds (out_of_range).
Result<SweptParameter> parse_sweep(const std::string& text, const std::vector<description::Parameter>& parameters);

struct ExplorationRequest {
    std::vector<SweptParameter> sweep = {};  ///< every combination; other parameters keep the design's values
    int samples = 0;                         ///< designs drawn from the bounds (sample_of_seed)
    int starts = 0;                          ///< runs of the optimiser; the first from the design's own values
    std::uint64_t seed = 1;                  ///< of samples and starts, as of `optimise --starts`: seeds_of_list
};

/// There is an end to what is planned before the first is made.
inline constexpr int most_designs = 1'000'000;

/// Each job once. Errors, all that are found: a parameter that is not there or swept twice, values that are not allowed, more than
/// most_designs of a kind, nothing to explore (missing_key).
Result<std::vector<ExplorationJob>> jobs_of(const problem::DesignProblem& problem, const ExplorationRequest& request);

/// The result of a job as a line of the file has it. What a design's own shapes and quantities throw becomes a result with the status
/// "failed", but for std::bad_alloc. Throws core::base::Stopped where should_stop ended it.
nlohmann::ordered_json result_of(const problem::DesignProblem& problem, const ExplorationJob& job,
                                 const std::function<bool()>& should_stop);
/// The result of a job whose workers were lost: "lost". It is tried again when the exploration goes on.
nlohmann::ordered_json lost_result(const ExplorationJob& job, const std::string& reason);

/// "design 3 of 12 is feasible, objective 0.25"
std::string progress_text(int done, int of, const nlohmann::ordered_json& result);

struct ExploreOptions {
    std::function<bool()> should_stop = {};  ///< optional
    /// Optional: once a result is in the file, with how many of the jobs are done; from one thread at a time.
    std::function<void(int done, int of, const nlohmann::ordered_json& result)> on_result = {};
};

struct Explored {
    bool interrupted = false;
    Errors unwritten;  ///< why the file could not take a result, after which nothing more was tried; the file object has them all
};

/// Runs those of the jobs that the file has no result of, on the threads that loops may use (core/base/parallel.hpp), and adds each result
/// to the file as it comes.
Explored explore(const problem::DesignProblem& problem, const std::vector<ExplorationJob>& jobs, ExplorationFile& file,
                 const ExploreOptions& options);

}  // namespace fettle::design::studies
