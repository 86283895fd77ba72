// SPDX-License-Identifier: MIT
/// The scene of an example as text that a test changes and writes elsewhere.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace fettle::tests::design_support {

/// Finds the example's part files wherever it is written. Tests run in the project's folder.
inline nlohmann::json scene_of_example(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::absolute("examples/" + name);
    std::ifstream in(folder / (name + ".scene.json"));
    nlohmann::json scene = nlohmann::json::parse(in);
    for (nlohmann::json& body : scene["bodies"]) {
        nlohmann::json& part = body["shape"]["part"];
        if (part.get<std::string>().ends_with(".part.json")) part = (folder / part.get<std::string>()).string();
    }
    return scene;
}

}  // namespace fettle::tests::design_support
