// SPDX-License-Identifier: MIT
#include "fettle/design/reading/design_text.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/hash.hpp"
#include "fettle/core/part_files/part_file.hpp"
#include "fettle/design/reading/process_file.hpp"

namespace fettle::design::reading {

namespace {

namespace fs = std::filesystem;

// 10 and 10.0 are the same number, however they are written.
void make_numbers_equal(nlohmann::json& json) {
    if (json.is_number()) json = json.get<double>();
    if (!json.is_structured()) return;
    for (auto& child : json) make_numbers_equal(child);
}

// Everything of a scene that is not in its own text: meshes, which come from files or are made from dimensions, and part files, which say
// what becomes of them at other dimensions.
void append_bytes(std::string& text, const void* data, size_t size) { text.append(static_cast<const char*>(data), size); }

// Names of processes that are files, which stay where they are.
void move_processes(nlohmann::ordered_json& json, const std::string& folder, const std::string& other) {
    const auto move = [&](nlohmann::ordered_json& holder) {
        if (holder.is_object() && holder.contains("process"))
            holder["process"] = process_name_from(holder["process"].get<std::string>(), folder, other);
    };
    move(json);
    if (!json.contains("tolerances")) return;
    for (auto& entry : json["tolerances"]) move(entry);
}

}  // namespace

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
    std::error_code failure;
    const fs::path scene = fs::relative(fs::absolute(file.scene_path), fs::absolute(directory), failure);
    json["scene"] = failure || scene.empty() ? fs::absolute(file.scene_path).string() : scene.generic_string();
    move_processes(json, fs::path(file.path).parent_path().string(), directory);
    json.erase("output");  // it was relative to the first file's folder
    return json.dump(2) + "\n";
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
    return json.dump(2) + "\n";
}

std::string design_hash(const DesignFile& file) {
    auto json = nlohmann::json::parse(file.text);
    for (const char* key : {"$schema", "description", "optimiser", "output", "scene"}) json.erase(key);
    make_numbers_equal(json);
    std::string all = std::string(core::base::version()) + "\n" + json.dump() + "\n";
    if (const Result<std::string> scene = core::files::read_file(file.scene_path)) all += *scene;
    for (const core::scene::Body& body : file.design.scene.bodies) {
        append_bytes(all, body.mesh.vertices.data(), static_cast<size_t>(body.mesh.vertices.size()) * sizeof(double));
        append_bytes(all, body.mesh.triangles.data(), body.mesh.triangles.size() * sizeof(core::geometry::Triangle));
        if (!body.shape || !body.shape->part.ends_with(core::part_files::part_file_ending)) continue;
        if (const Result<std::string> part = core::files::read_file(body.shape->part)) all += *part;
    }
    return core::files::hash_of(all);
}

}  // namespace fettle::design::reading
