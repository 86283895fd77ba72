// SPDX-License-Identifier: MIT
#include "tests/benchmarks/reference_table.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "core/files/atomic_file.hpp"

namespace fettle::tests::benchmarks {
namespace {

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, '\t');) fields.push_back(field);
    return fields;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), why.c_str());
    std::exit(3);
}

}  // namespace

std::vector<ReferenceRun> read_reference_table(const std::string& path) {
    const auto text = core::files::read_file(path);
    if (!text) refuse(path, text.errors().front().message);
    std::istringstream lines(*text);
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = split(line);
    const auto column = [&](const char* name) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end()) refuse(path, std::string("no column ") + name);
        return static_cast<std::size_t>(at - names.begin());
    };
    const std::size_t scene = column("scene"), steps = column("steps_run"), seconds = column("cpu_s");
    std::vector<ReferenceRun> table;
    while (std::getline(lines, line)) {
        const std::vector<std::string> fields = split(line);
        if (fields.empty()) continue;
        if (fields.size() <= std::max({scene, steps, seconds})) refuse(path, "too few columns: " + line);
        std::string name = fields[scene];
        if (name.ends_with(".json")) name.resize(name.size() - 5);
        const ReferenceRun run{name, std::atoi(fields[steps].c_str()), std::atof(fields[seconds].c_str())};
        if (run.steps <= 0 || !(run.seconds > 0)) refuse(path, "no steps, or no time: " + line);
        table.push_back(run);
    }
    return table;
}

const ReferenceRun* find_reference(const std::vector<ReferenceRun>& table, const std::string& scene) {
    const auto at = std::find_if(table.begin(), table.end(), [&](const ReferenceRun& run) { return run.scene == scene; });
    return at == table.end() ? nullptr : &*at;
}

}  // namespace fettle::tests::benchmarks
