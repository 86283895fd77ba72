// SPDX-License-Identifier: MIT
#include "tests/benchmarks/program_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <vector>

#include "core/files/json_document.hpp"
#include "tests/benchmarks/child_run.hpp"

namespace fettle::tests::benchmarks {
namespace {

// The answer is one member a line; times and memory differ from run to run.
std::uint64_t bits_of(const std::string& answer) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    std::istringstream lines(answer);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("_seconds\"") != std::string::npos || line.find("peak_memory_bytes") != std::string::npos) continue;
        for (const char c : line) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    return hash;
}

int execute(std::vector<std::string> arguments) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(pointers.front(), pointers.data());
    return 127;
}

ProgramRun run_once(const std::string& scene, const ProgramOptions& options) {
    std::vector<std::string> arguments{options.program, "--threads", std::to_string(options.threads), "simulate", scene,
                                       "--json",        "--quiet"};
    if (options.steps >= 0) arguments.insert(arguments.end(), {"--steps", std::to_string(options.steps)});
    if (!options.mesh_dir.empty()) arguments.insert(arguments.end(), {"--mesh-dir", options.mesh_dir});
    const ChildRun child = run_child([&] { return execute(arguments); }, options.seconds);
    ProgramRun run;
    run.cpu_seconds = child.cpu_seconds;
    run.wall_seconds = child.wall_seconds;
    run.peak_memory_bytes = child.peak_memory_bytes;
    auto answer = core::files::JsonDocument::parse(child.out, "answer");
    if (!answer) {
        run.status = child.ran_out_of_time() ? "hung" : "crashed";
        run.message = "exit code " + std::to_string(child.exit_code) + ", signal " + std::to_string(child.signal);
        return run;
    }
    const core::files::JsonNode root = answer->root();
    const auto real = [&](const char* key) { return root[key].unless_null().number().value_or(0); };
    run.status = root["status"].string().value_or("crashed");
    run.message = root["message"].string().value_or("");
    if (run.status == "error") {
        for (const auto& error : root["errors"].elements()) run.message += error["message"].string().value_or("") + " ";
    }
    run.steps = static_cast<int>(real("steps"));
    run.start_seconds = real("start_seconds");
    run.stepping_seconds = real("wall_seconds");
    run.certify_seconds = real("certify_seconds");
    run.minimum_distance = root["minimum_distance"].unless_null().number().value_or(std::numeric_limits<double>::infinity());
    run.bits = bits_of(child.out);
    return run;
}

}  // namespace

ProgramRun run_program(const std::string& scene, const ProgramOptions& options) {
    ProgramRun best = run_once(scene, options);
    double spent = best.cpu_seconds;
    for (int i = 1; i < options.repeat && best.status == "ok" && spent < options.repeat_seconds; ++i) {
        ProgramRun run = run_once(scene, options);
        spent += run.cpu_seconds;
        if (run.bits != best.bits) {
            run.status = "not repeatable";
            return run;
        }
        run.wall_seconds = std::min(run.wall_seconds, best.wall_seconds);
        if (run.cpu_seconds < best.cpu_seconds) {
            best = run;
        } else {
            best.wall_seconds = run.wall_seconds;
        }
    }
    return best;
}

std::string program_of_this_build() {
    const char* elsewhere = std::getenv("FETTLE_PROGRAM");
    return elsewhere != nullptr && *elsewhere != '\0' ? elsewhere : FETTLE_PROGRAM;
}

}  // namespace fettle::tests::benchmarks
