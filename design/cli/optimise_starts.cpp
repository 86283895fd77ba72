// SPDX-License-Identifier: MIT
#include "design/cli/optimise_starts.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>

#include "core/base/parallel.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_text.hpp"
#include "design/answers/run_folder.hpp"
#include "design/cli/answers.hpp"
#include "design/cli/child_process.hpp"
#include "design/tolerances/yield.hpp"

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> arguments_of(const StartsRequest& request, const StartResult& start, const CommonOptions& common, int threads) {
    std::vector<std::string> words{"optimise", request.design, "--seed",         std::to_string(start.seed),
                                   "--out",    start.out,      "--threads",      std::to_string(threads),
                                   "--quiet",  "--no-report",  "--no-resolution"};
    if (!request.optimiser.empty()) words.insert(words.end(), {"--optimiser", request.optimiser});
    if (request.resume) words.emplace_back("--resume");
    if (request.repair) words.emplace_back("--repair");
    if (common.strict) words.emplace_back("--strict");
    if (common.allow_programs) words.emplace_back("--allow-programs");
    for (const std::string& folder : common.mesh_dirs) words.insert(words.end(), {"--mesh-dir", folder});
    return words;
}

std::string last_line(const std::string& text) {
    const size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) return {};
    const size_t begin = text.find_last_of('\n', end);
    return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

// Does it have what is told of it?
bool is_whole(const Json& result) {
    const auto has = [&](const char* key, const auto& is) { return result.contains(key) && is(result[key]); };
    const auto text = [](const Json& value) { return value.is_string(); };
    const auto texts = [&](const Json& value) { return value.is_array() && std::all_of(value.begin(), value.end(), text); };
    return result.is_object() && has("status", text) && has("message", text) && has("limited_by", texts) &&
           has("evaluations", [](const Json& value) { return value.is_number_integer(); });
}

void read_result(StartResult& start, int exit_code) {
    start.exit_code = exit_code;
    const std::filesystem::path folder = start.out;
    const Result<std::string> text = core::files::read_file(folder / "result.json");
    if (text && core::files::is_safe_json_text(*text)) start.result = Json::parse(*text, nullptr, false);
    if (is_whole(start.result)) {
        start.status = start.result["status"].get<std::string>();
        start.message = start.result["message"].get<std::string>();
        return;
    }
    start.result = Json();
    start.status = "failed";
    const Result<std::string> log = core::files::read_file(folder / "log.txt");
    start.message = log ? last_line(*log) : "";
    if (start.message.empty()) start.message = "ended with exit code " + std::to_string(exit_code) + ", no result written";
}

// The number at a key, NaN where there is none.
double number(const Json& result, const char* key) {
    if (!result.is_object() || !result.contains(key) || !result[key].is_number()) return std::numeric_limits<double>::quiet_NaN();
    return result[key].get<double>();
}

using Rank = std::pair<double, double>;  // violation, then what is minimised

// Nothing: no design was evaluated.
std::optional<Rank> rank_of(const Json& result) {
    const double violation = std::max(0.0, number(result, "constraint_violation")), objective = number(result, "objective");
    if (!(violation >= 0) || !std::isfinite(objective)) return std::nullopt;
    return Rank{violation, result.contains("repair") ? number(result["repair"], "distance") : objective};
}

std::string joined_names(const Json& list) {
    std::string text;
    for (const Json& name : list) text += (text.empty() ? "" : "; ") + name.get<std::string>();
    return text;
}

std::string line_of(const StartResult& start) {
    std::string text = formatted("seed %-8llu %-12s", static_cast<unsigned long long>(start.seed), start.status.c_str());
    const double objective = number(start.result, "objective");
    if (!std::isfinite(objective)) return text + " " + start.message;  // no design was evaluated
    text += formatted(" objective %-12.8g %3d %s", objective, start.result["evaluations"].get<int>(),
                      start.result["evaluations"] == 1 ? "evaluation" : "evaluations");
    if (const auto sides = start.result.find("sides"); sides != start.result.end() && sides->is_object())
        for (const auto& [joint, side] : sides->items())
            if (side.is_string()) text += ", " + side.get<std::string>() + " at " + joint;
    const double violation = number(start.result, "constraint_violation");
    if (violation > 0) return text + formatted(", largest violation %.3g", violation);
    const std::string limits = joined_names(start.result["limited_by"]);
    return limits.empty() ? text : text + ", held by " + limits;
}

struct Running {
    size_t start;
    core::files::Process process;
};

// Those that have ended leave the list.
bool collect(std::vector<Running>& running, std::vector<StartResult>& starts, Console& console) {
    bool any = false;
    for (auto run = running.begin(); run != running.end();) {
        const std::optional<int> code = run->process.ended();
        if (!code) {
            ++run;
            continue;
        }
        read_result(starts[run->start], *code);
        console.narrate(line_of(starts[run->start]));
        run = running.erase(run);
        any = true;
    }
    return any;
}

}  // namespace

std::vector<StartResult> run_starts(const StartsRequest& request, const CommonOptions& common, Console& console) {
    std::vector<StartResult> starts;
    for (const std::uint64_t seed : request.seeds) {
        const std::string folder = (std::filesystem::path(request.out) / ("start-" + std::to_string(seed))).string();
        starts.push_back({seed, folder, "not run", "", Json(), 0});
    }
    const int cores = core::base::thread_count(), at_once = std::min<int>(cores, count_of(starts));
    std::vector<Running> running;
    size_t next = 0;
    while (next < starts.size() || !running.empty()) {
        const bool stop = interrupted();
        if (stop) next = starts.size();
        for (Running& run : running) {
            if (stop) run.process.ask_to_stop();
        }
        for (; next < starts.size() && count_of(running) < at_once; ++next) {
            const std::filesystem::path folder = starts[next].out;
            std::error_code fault;
            std::filesystem::create_directories(folder, fault);
            const Errors others = answers::others_file(folder / "result.json");
            if (!fault && others.empty())
                std::filesystem::remove(folder / "result.json", fault);  // of an earlier run: it would pass for this one's
            if (!others.empty()) {
                starts[next] = {starts[next].seed, folder.string(), "failed", others[0].where + ": " + others[0].message, Json(),
                                exit_bad_input};
                continue;
            }
            if (fault) {
                starts[next] = {starts[next].seed, folder.string(), "failed", "its folder cannot be written: " + fault.message(), Json(),
                                exit_bad_input};
                continue;
            }
            running.push_back({next, start_self(arguments_of(request, starts[next], common, cores / at_once), folder / "log.txt")});
        }
        if (collect(running, starts, console)) {
            const auto done = static_cast<int>(next - running.size());
            if (!stop) console.progress("      starts", done, count_of(starts));
            continue;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return starts;
}

std::optional<size_t> best_start(const std::vector<StartResult>& starts) {
    std::optional<size_t> best;
    std::optional<Rank> best_rank;
    for (size_t i = 0; i < starts.size(); ++i) {
        const std::optional<Rank> rank = rank_of(starts[i].result);
        if (!rank || (best_rank && !(*rank < *best_rank))) continue;
        best = i;
        best_rank = rank;
    }
    return best;
}

std::optional<BestReached> best_reached(const std::vector<StartResult>& starts) {
    constexpr double within = 1e-3, confidence = 0.95;
    const std::optional<size_t> best = best_start(starts);
    const std::optional<Rank> least = best ? rank_of(starts[*best].result) : std::nullopt;
    if (!least || least->first > 0) return std::nullopt;
    BestReached out;
    for (const StartResult& start : starts) {
        if (start.seed == 0 || start.status == "not run" || start.status == "interrupted") continue;
        ++out.of;
        const std::optional<Rank> rank = rank_of(start.result);
        out.starts += rank && rank->first <= 0 && rank->second - least->second <= within * std::abs(least->second);
    }
    if (out.of == 0) return std::nullopt;
    const tolerances::CountedYield share = tolerances::counted_yield(out.starts, out.of, confidence);
    out.least = share.least.within;
    out.most = share.most.within;
    return out;
}

Json best_reached_json(const std::vector<StartResult>& starts) {
    const std::optional<BestReached> reached = best_reached(starts);
    if (!reached) return {};
    return {{"starts", reached->starts}, {"of", reached->of}, {"share_least", reached->least}, {"share_most", reached->most}};
}

Json starts_json(const std::vector<StartResult>& starts) {
    Json list = Json::array();
    for (const StartResult& start : starts) {
        Json row{{"seed", start.seed}, {"status", start.status}, {"message", start.message}};
        for (const char* key :
             {"objective", "constraint_violation", "evaluations", "limited_by", "sides", "parameters_start", "parameters", "repair"}) {
            if (start.result.is_object() && start.result.contains(key)) row[key] = start.result[key];
        }
        if (!row.contains("objective")) row["objective"] = Json();
        if (!row.contains("evaluations")) row["evaluations"] = 0;
        row["out"] = start.out;
        list.push_back(std::move(row));
    }
    return list;
}

std::string starts_text(const std::vector<StartResult>& starts) {
    std::string text;
    for (const StartResult& start : starts) text += "  " + line_of(start) + "\n";
    if (const std::optional<BestReached> reached = best_reached(starts))
        text += formatted("%d of %d random starts reach the best within 0.1%% (of all random starts %.0f to %.0f%%, at 95%% confidence)\n",
                          reached->starts, reached->of, 100 * reached->least, 100 * reached->most);
    return text;
}

}  // namespace fettle::design::cli
