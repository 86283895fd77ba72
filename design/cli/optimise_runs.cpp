// SPDX-License-Identifier: MIT
#include "design/cli/optimise_runs.hpp"

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

namespace fettle::design::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> arguments_of(const RunRequest& request, const RunSettings& settings, const CommonOptions& common, int threads) {
    std::vector<std::string> words{"optimise", request.design, "--out",          request.out, "--threads", std::to_string(threads),
                                   "--quiet",  "--no-report",  "--no-resolution"};
    words.insert(words.end(), request.words.begin(), request.words.end());
    if (!settings.optimiser.empty()) words.insert(words.end(), {"--optimiser", settings.optimiser});
    if (settings.resume) words.emplace_back("--resume");
    if (settings.repair) words.emplace_back("--repair");
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

void read_result(RunResult& run, int exit_code) {
    run.exit_code = exit_code;
    const std::filesystem::path folder = run.out;
    const Result<std::string> text = core::files::read_file(folder / "result.json");
    if (text && core::files::is_safe_json_text(*text)) run.result = Json::parse(*text, nullptr, false);
    if (is_whole(run.result)) {
        run.status = run.result["status"].get<std::string>();
        run.message = run.result["message"].get<std::string>();
        return;
    }
    run.result = Json();
    run.status = "failed";
    const Result<std::string> log = core::files::read_file(folder / "log.txt");
    run.message = log ? last_line(*log) : "";
    if (run.message.empty()) run.message = "ended with exit code " + std::to_string(exit_code) + ", no result written";
}

// The number at a key, NaN where there is none.
double number(const Json& result, const char* key) {
    if (!result.is_object() || !result.contains(key) || !result[key].is_number()) return std::numeric_limits<double>::quiet_NaN();
    return result[key].get<double>();
}

std::string joined_names(const Json& list) {
    std::string text;
    for (const Json& name : list) text += (text.empty() ? "" : "; ") + name.get<std::string>();
    return text;
}

struct Running {
    size_t run;
    core::files::Process process;
};

// Those that have ended leave the list.
bool collect(std::vector<Running>& running, std::vector<RunResult>& runs, Console& console) {
    bool any = false;
    for (auto run = running.begin(); run != running.end();) {
        const std::optional<int> code = run->process.ended();
        if (!code) {
            ++run;
            continue;
        }
        read_result(runs[run->run], *code);
        console.narrate(line_of(runs[run->run]));
        run = running.erase(run);
        any = true;
    }
    return any;
}

}  // namespace

RunResult failed_run(const RunRequest& request, std::string message) {
    return {request.name, request.out, "failed", std::move(message), Json(), exit_bad_input};
}

std::vector<RunResult> run_together(const std::vector<RunRequest>& requests, const RunSettings& settings, const CommonOptions& common,
                                    Console& console) {
    std::vector<RunResult> runs;
    for (const RunRequest& request : requests) runs.push_back({request.name, request.out, "not run", "", Json(), 0});
    if (requests.empty()) return runs;
    const int cores = core::base::thread_count(), at_once = std::min<int>(cores, count_of(runs));
    std::vector<Running> running;
    size_t next = 0;
    while (next < runs.size() || !running.empty()) {
        const bool stop = interrupted();
        if (stop) next = runs.size();
        for (Running& run : running) {
            if (stop) run.process.ask_to_stop();
        }
        for (; next < runs.size() && count_of(running) < at_once; ++next) {
            const std::filesystem::path folder = requests[next].out;
            std::error_code fault;
            std::filesystem::create_directories(folder, fault);
            const Errors others = answers::others_file(folder / "result.json");
            if (!fault && others.empty())
                std::filesystem::remove(folder / "result.json", fault);  // of an earlier run: it would pass for this one's
            if (!others.empty()) {
                runs[next] = failed_run(requests[next], others[0].where + ": " + others[0].message);
            } else if (fault) {
                runs[next] = failed_run(requests[next], "its folder cannot be written: " + fault.message());
            } else {
                const std::vector<std::string> words = arguments_of(requests[next], settings, common, cores / at_once);
                running.push_back({next, start_self(words, folder / "log.txt")});
            }
        }
        if (collect(running, runs, console)) {
            const auto done = static_cast<int>(next - running.size());
            if (!stop) console.progress("      " + settings.what, done, count_of(runs));
            continue;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return runs;
}

std::optional<std::pair<double, double>> rank_of(const Json& result) {
    const double violation = std::max(0.0, number(result, "constraint_violation")), objective = number(result, "objective");
    if (!(violation >= 0) || !std::isfinite(objective)) return std::nullopt;
    return std::pair{violation, result.contains("repair") ? number(result["repair"], "distance") : objective};
}

std::string line_of(const RunResult& run) {
    std::string text = formatted("%-13s %-12s", run.name.c_str(), run.status.c_str());
    const double objective = number(run.result, "objective");
    if (!std::isfinite(objective)) return text + " " + run.message;  // no design was evaluated
    text += formatted(" objective %-12.8g %3d %s", objective, run.result["evaluations"].get<int>(),
                      run.result["evaluations"] == 1 ? "evaluation" : "evaluations");
    if (const auto sides = run.result.find("sides"); sides != run.result.end() && sides->is_object())
        for (const auto& [joint, side] : sides->items())
            if (side.is_string()) text += ", " + side.get<std::string>() + " at " + joint;
    const double violation = number(run.result, "constraint_violation");
    if (violation > 0) return text + formatted(", largest violation %.3g", violation);
    const std::string limits = joined_names(run.result["limited_by"]);
    return limits.empty() ? text : text + ", held by " + limits;
}

void add_run(Json& row, const RunResult& run) {
    row["status"] = run.status;
    row["message"] = run.message;
    for (const char* key :
         {"objective", "constraint_violation", "evaluations", "limited_by", "sides", "parameters_start", "parameters", "repair"}) {
        if (run.result.is_object() && run.result.contains(key)) row[key] = run.result[key];
    }
    if (!row.contains("objective")) row["objective"] = Json();
    if (!row.contains("evaluations")) row["evaluations"] = 0;
    row["out"] = run.out;
}

}  // namespace fettle::design::cli
