// SPDX-License-Identifier: MIT
#include "design/cli/dask_cluster.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/files/json_text.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Where the package lies beside this program: in the build tree, or installed with it.
std::string package_path(const fs::path& program) {
    for (const char* place : {"../python", "../lib/python3/dist-packages"}) {
        const fs::path folder = program.parent_path() / place;
        if (fs::exists(folder / "fettle" / "__init__.py")) return fs::weakly_canonical(folder).string();
    }
    return {};
}

// The package, and what PYTHONPATH says. An entry of it that is empty or relative is the current folder, or lies in it: it is left out.
std::string module_path(const fs::path& program) {
    std::string path = package_path(program);
    const char* given = std::getenv("PYTHONPATH");
    std::istringstream entries(given == nullptr ? "" : given);
    for (std::string entry; std::getline(entries, entry, ':');)
        if (fs::path(entry).is_absolute()) path += (path.empty() ? "" : ":") + entry;
    return path;
}

std::string interpreter(const fs::path& program) {
    for (const std::string& place : {(program.parent_path() / "python3").string(), std::string("/usr/bin/python3")})
        if (access(place.c_str(), X_OK) == 0) return place;
    return "python3";
}

Json parsed(const std::string& line) {
    return core::files::is_safe_json_text(line) ? Json::parse(line, nullptr, false) : Json(Json::value_t::discarded);
}

Error ended_early() {
    return {ErrorCode::inconsistent, "--dask",
            "Python ended before all results had come (what it said stands above); the same command goes on with the others"};
}

}  // namespace

Result<DaskCluster> DaskCluster::connect(const std::string& address, const DaskDesign& design) {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    setenv("PYTHONPATH", module_path(program).c_str(), 1);
    // -P: the current folder, which may be anyone's, is no place of modules; nor is it for the processes that Python starts.
    std::optional<TalkingProcess> python;
    try {
        python.emplace(std::vector<std::string>{interpreter(program), "-P", "-m", "fettle", "explore-on-dask"});
    } catch (const std::system_error& error) {
        return Error{ErrorCode::file_not_found, "--dask", "python3 could not be started: " + error.code().message()};
    }
    DaskCluster cluster(*std::move(python));
    const Json request{{"address", address},
                       {"design", fs::absolute(design.path).string()},
                       {"mesh_dirs", design.mesh_dirs},
                       {"allow_programs", design.allow_programs}};
    cluster.process_.tell(request.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
    const std::optional<std::string> line = cluster.process_.next_line({});
    const Json answer = line ? parsed(*line) : Json(Json::value_t::discarded);
    if (!answer.is_object())
        return Error{ErrorCode::file_not_found, "--dask",
                     "a Dask cluster takes the Python package (Debian's python3, python3-numpy and python3-distributed; in the project's "
                     "folder `cmake --build build/release --target fettle_python` builds it); what Python said stands above"};
    if (answer.contains("error"))
        return Error{ErrorCode::inconsistent, answer.value("where", "--dask"), answer["error"].get<std::string>()};
    return cluster;
}

Result<studies::Explored> DaskCluster::explore(const std::vector<studies::ExplorationJob>& jobs, studies::ExplorationFile& file,
                                               const studies::ExploreOptions& options) {
    std::map<std::string, const studies::ExplorationJob*> waiting;
    std::string told;
    for (const studies::ExplorationJob& job : jobs) {
        if (file.has(job.key())) continue;
        waiting[job.key()] = &job;
        const std::vector<double> point(job.point.begin(), job.point.end());
        told += Json{{"kind", studies::to_string(job.kind)}, {"point", point}, {"seed", job.seed}}.dump() + "\n";
    }
    studies::Explored out;
    if (waiting.empty()) return out;
    if (!process_.tell(told)) return ended_early();
    process_.tell_no_more();
    int done = count_of(jobs) - static_cast<int>(waiting.size());
    while (!waiting.empty()) {
        const std::optional<std::string> line = process_.next_line(options.should_stop);
        out.interrupted = options.should_stop && options.should_stop();
        if (out.interrupted) return out;
        if (!line) return ended_early();
        Json result = parsed(*line);
        if (!result.is_object() || !result.contains("key") || !result["key"].is_string()) return ended_early();
        const auto job = waiting.find(result["key"].get<std::string>());
        if (job == waiting.end()) continue;
        if (!result.contains("status")) result = studies::lost_result(*job->second, "two workers were lost on this design");
        waiting.erase(job);
        file.append(result);
        out.unwritten = file.unwritten();
        if (!out.unwritten.empty()) return out;
        if (options.on_result) options.on_result(++done, count_of(jobs), result);
    }
    return out;
}

}  // namespace fettle::design::cli
