// SPDX-License-Identifier: MIT
#include "design/reading/design_text.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/hash.hpp"
#include "core/files/json_dump.hpp"
#include "design/reading/process_file.hpp"

namespace fettle::design::reading {

namespace {

namespace fs = std::filesystem;

// 10 and 10.0 are the same number, however they are written.
void make_numbers_equal(nlohmann::json& json) {
    if (json.is_number()) json = json.get<double>();
    if (!json.is_structured()) return;
    for (auto& child : json) make_numbers_equal(child);
}

// Adds all of a mesh: its file, or its maker, may depend on other files that nobody opened here.
void add_mesh(core::files::Fnv1a& hash, const core::geometry::Mesh& mesh) {
    const auto add = [&](const auto& list, const auto& add_one) {
        hash.add(static_cast<std::uint64_t>(list.size()));
        for (const auto& one : list) add_one(one);
    };
    const auto index = [&](int i) { hash.add(static_cast<std::uint32_t>(i)); };
    const auto indices = [&](const auto& corners) { std::for_each(corners.begin(), corners.end(), index); };
    const auto name = [&](const std::string& text) { hash.add(text + '\n'); };
    add(mesh.vertices.reshaped(), [&](double x) { hash.add(x); });
    add(mesh.triangles, indices);
    add(mesh.edges, indices);
    add(mesh.codimensional_points, index);
    add(mesh.triangle_face, index);
    add(mesh.face_names, name);
}

// Names of processes that are files, which stay where they are.
void move_processes(nlohmann::ordered_json& json, const std::string& folder, const std::string& other) {
    const auto move = [&](nlohmann::ordered_json& holder) {
        if (holder.is_object() && holder.contains("process"))
            holder["process"] = process_name_from(holder["process"].get<std::string>(), folder, other);
    };
    move(json);
    if (json.contains("choices"))
        for (auto& [name, choice] : json["choices"].items())
            if (choice.is_object() && choice.contains("options"))
                for (auto& option : choice["options"]) move(option);
    if (!json.contains("tolerances")) return;
    for (auto& entry : json["tolerances"]) move(entry);
}

}  // namespace

Result<std::string> scene_from(const DesignFile& file, const std::string& directory) {
    std::error_code failure;
    const fs::path scene = fs::relative(fs::absolute(file.scene_path), fs::current_path() / directory, failure);
    std::string name = failure || scene.empty() ? fs::absolute(file.scene_path).string() : scene.generic_string();
    if (core::base::is_utf8(name)) return name;
    return Error{
        ErrorCode::inconsistent, directory,
        "from here the scene is " + name + ", which is not UTF-8, so that no design can name it; choose a folder beside the scene"};
}

std::string design_text(const DesignFile& file, const VectorX& values, const std::string& directory) {
    auto json = nlohmann::ordered_json::parse(file.text);
    for (size_t k = 0; k < file.design.parameters.size(); ++k) {
        const description::Parameter& parameter = file.design.parameters[k];
        auto& entry = json["parameters"][k];
        const double value = values[k];
        if (value != parameter.value && !entry.contains("reference"))
            entry["reference"] =
                entry.contains("value") ? entry["value"] : nlohmann::ordered_json(description::from_si(parameter.value, parameter.unit));
        // A value at a bound is written as the bound is: a neighbour with the same SI value could lie outside.
        entry["value"] = value == parameter.lower   ? entry["lower"]
                         : value == parameter.upper ? entry["upper"]
                                                    : nlohmann::ordered_json(description::from_si(value, parameter.unit));
    }
    const Result<std::string> scene = scene_from(file, directory);
    json["scene"] = scene ? *scene : fs::absolute(file.scene_path).string();
    move_processes(json, fs::path(file.path).parent_path().string(), directory);
    json.erase("output");  // it was relative to the first file's folder
    return core::files::dumped(json, 2) + "\n";
}

std::string text_with_choices(const DesignFile& file, const description::Combination& combination, const VectorX& values) {
    auto json = nlohmann::ordered_json::parse(file.text);
    for (std::size_t k = 0; k < file.choices.size(); ++k) {
        const description::Choice& choice = file.choices[k];
        const std::string& option = choice.options[static_cast<std::size_t>(combination[k])];
        json["choices"][choice.name]["value"] = choice.is_ordered ? nlohmann::ordered_json::parse(option) : nlohmann::ordered_json(option);
    }
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        auto& entry = json["parameters"][static_cast<std::size_t>(k)];
        entry["value"] = description::from_si(values[k], file.design.parameters[static_cast<std::size_t>(k)].unit);
        entry.erase("reference");
    }
    return core::files::dumped(json, 2) + "\n";
}

std::string text_with_sides(const DesignFile& file, const std::vector<core::model::JointSide>& sides) {
    using Json = nlohmann::ordered_json;
    auto json = Json::parse(file.text);
    const std::vector<core::scene::Joint>& joints = file.design.scene.mechanism.joints;
    for (const core::model::JointSide& side : sides) {
        const auto joint = std::find_if(joints.begin(), joints.end(), [&](const auto& each) { return each.name == side.joint; });
        const Json::json_pointer place = Json::json_pointer("/joints") / side.joint / "assemble";
        const Json::json_pointer numbered = Json::json_pointer("/joints") / static_cast<size_t>(joint - joints.begin()) / "assemble";
        const auto unset = [&](Json& holder) {
            if (!holder.contains("set")) return;
            for (const std::string& old : {place.to_string(), numbered.to_string()})
                for (const char* within : {"", "/side", "/from", "/to"}) holder["set"].erase(old + within);
        };
        unset(json);
        if (json.contains("scenarios"))
            for (Json& scenario : json["scenarios"]) unset(scenario);
        Json said{{"side", core::model::to_string(side.assemble.side)}};
        if (!side.assemble.from.empty()) said["from"] = side.assemble.from;
        if (!side.assemble.to.empty()) said["to"] = side.assemble.to;
        json["set"][place.to_string()] = std::move(said);
    }
    return core::files::dumped(json, 2) + "\n";
}

std::string design_hash(const DesignFile& file) {
    auto json = nlohmann::json::parse(file.text);
    for (const char* key : {"$schema", "description", "optimiser", "output", "scene"}) json.erase(key);
    make_numbers_equal(json);
    core::files::Fnv1a hash;
    hash.add(std::string(core::base::version()) + "\n" + core::files::dumped(json) + "\n" + file.read_as + "\n");
    // By their names as the scene has them, so that the folder can be moved.
    std::error_code unresolved;
    const fs::path folder = fs::weakly_canonical(fs::absolute(file.scene_path).parent_path(), unresolved);
    std::set<std::pair<std::string, std::uint64_t>> files;
    for (const auto& [path, contents] : file.files)
        files.emplace(fs::weakly_canonical(path, unresolved).lexically_proximate(folder).string(), contents);
    for (const auto& [name, contents] : files) {
        hash.add(name + "\n");
        hash.add(contents);
    }
    for (const core::scene::Body& body : file.design.scene.bodies) add_mesh(hash, body.mesh);
    return core::files::hexadecimal(hash.value());
}

}  // namespace fettle::design::reading
