// SPDX-License-Identifier: MIT
#include "design/cli/starters.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fettle::design::cli {

namespace {

struct StarterFile {
    const char *starter, *name, *text;
};

// Made by design/cli/CMakeLists.txt.
constexpr StarterFile starter_files[] = {
#include <starter_files.inc>
};

std::vector<Starter> collected() {
    std::vector<Starter> list;
    for (const StarterFile& file : starter_files) {
        auto found = std::find_if(list.begin(), list.end(), [&](const Starter& starter) { return starter.name == file.starter; });
        if (found == list.end()) found = list.insert(list.end(), {file.starter, "", {}});
        found->files.emplace_back(file.name, file.text);
        const auto json = nlohmann::json::parse(file.text, nullptr, false);
        if (found->description.empty() && json.contains("description")) found->description = json["description"].get<std::string>();
    }
    std::sort(list.begin(), list.end(), [](const Starter& a, const Starter& b) { return a.name < b.name; });
    return list;
}

}  // namespace

const std::vector<Starter>& starters() {
    static const std::vector<Starter> list = collected();
    return list;
}

}  // namespace fettle::design::cli
