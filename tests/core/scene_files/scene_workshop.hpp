// SPDX-License-Identifier: MIT
/// Scene files to read in tests, as JSON to change, beside meshes that are really there.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/scene_files/scene_reader.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::core::scene_files::test_support {

namespace fs = std::filesystem;
using nlohmann::json;

/// A folder with a scene in scenes/ and meshes in three of the places where they are looked for.
class Workshop {
public:
    Workshop() {
        fs::create_directories(root / "scenes");
        fs::create_directories(root / "meshes");
        fs::create_directories(root / "elsewhere");
        write("scenes/near.obj");
        write("meshes/above.obj");
        write("elsewhere/far.obj");
    }

    void write(const std::string& name, const std::string& more = {}) const {
        std::ofstream file(root / name);
        const auto box = tests::support::box_mesh({0, 0, 0}, {1, 2, 3});
        for (Eigen::Index i = 0; i < 8; ++i) file << "v " << box.vertices.col(i).transpose() << "\n";
        for (const auto& t : box.triangles) file << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
        file << more;
    }
    base::Result<scene::Scene> read(const json& scene, scene::ReadOptions options = {}) const {
        options.mesh_dirs.push_back((root / "elsewhere").string());
        return parse_scene(scene.dump(), (root / "scenes" / "a.scene.json").string(), options);
    }

    tests::support::TemporaryFolder folder;
    fs::path root = folder.path;
};

inline json plain() {
    return json::parse(R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "box", "mesh": "near.obj", "density": 1240}]})");
}

/// `plain()` with one value replaced or added.
inline json with(const std::string& pointer, const json& value) {
    json scene = plain();
    scene[json::json_pointer(pointer)] = value;
    return scene;
}

using fettle::tests::support::contains;

}  // namespace fettle::core::scene_files::test_support
