// SPDX-License-Identifier: MIT
#include "design/reading/scene_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/base/text.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/part_files/part_file.hpp"
#include "core/scene/place.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "design/problem/design_problem.hpp"
#include "design/problem/moved_scene.hpp"

namespace fettle::design::reading {

namespace {

namespace fs = std::filesystem;
using core::scene::Scene;
using Json = nlohmann::ordered_json;

constexpr double rounding = 1e-12;  // of a number, or of a mesh's size

/// An element of a list by its number or by its name.
Json* element(Json& list, const std::string& name) {
    for (Json& each : list)
        if (each.is_object() && each.contains("name") && each["name"] == name) return &each;
    const bool is_number = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    const std::size_t number = is_number && name.size() < 10 ? std::stoul(name) : list.size();
    return number < list.size() ? &list[number] : nullptr;
}

/// What a design's `set` does to the text of its scene. Contract: the design has been read, so that every pointer leads somewhere.
void replace(Json& scene, const std::string& pointer, const Json& value) {
    Json* at = &scene;
    for (Json::json_pointer rest(pointer), next; !rest.empty(); rest = next) {
        std::string name = rest.to_string().substr(1);
        name.resize(std::min(name.find('/'), name.size()));
        next = Json::json_pointer(rest.to_string().substr(1 + name.size()));
        name = Json::json_pointer("/" + name).back();
        at = at->is_array() ? element(*at, name) : &(*at)[name];
        if (at == nullptr) return;
    }
    *at = value;
}

void apply(const Json& holder, Json& scene) {
    if (!holder.contains("set")) return;
    for (const auto& [pointer, value] : holder["set"].items()) replace(scene, pointer, value);
}

/// "12.5 mm"; plain numbers as they are.
Json number_text(double si, const Unit& unit) {
    const Json number = description::from_si(si, unit);
    return unit.dimension == core::base::Dimension::number ? number : Json(number.dump() + " " + std::string(unit.name));
}

/// A file beside the old scene, as it is called beside the new one; other names stay.
void move_name(Json& holder, const char* key, std::string_view ending, const fs::path& from, const fs::path& to) {
    if (!holder.contains(key) || !holder[key].is_string()) return;
    const std::string name = holder[key].get<std::string>();
    std::error_code failed;
    if (!fs::is_regular_file(from / name, failed) && (ending.empty() || !fs::is_regular_file(from / (name + std::string(ending)), failed)))
        return;
    const fs::path moved = fs::relative(fs::absolute(from / name), fs::current_path() / to, failed);
    if (!failed && !moved.empty()) holder[key] = moved.generic_string();
}

void move_names(Json& scene, const fs::path& from, const fs::path& to) {
    if (!scene.contains("bodies")) return;
    for (Json& body : scene["bodies"]) {
        move_name(body, "mesh", "", from, to);
        if (!body.contains("shape") || !body["shape"].is_object()) continue;
        Json& shape = body["shape"];
        move_name(shape, "part", core::part_files::part_file_ending, from, to);
        move_name(shape, "mesh", "", from, to);
        if (!shape.contains("handles") || !shape["handles"].is_object()) continue;
        for (auto& [name, handle] : shape["handles"].items())
            if (handle.is_object()) move_name(handle, "morph", "", from, to);
    }
}

/// Is what was read the scene that is meant? Every number of the table, and every mesh.
Errors differences(const Scene& read, const Scene& meant, const std::string& path) {
    Errors errors;
    const auto differs = [&](const std::string& place) {
        errors.push_back(
            {ErrorCode::unsupported, path + "#" + place, "differs from what the design has there, which a scene file cannot say"});
    };
    if (read.bodies.size() != meant.bodies.size()) differs("/bodies");
    for (const core::scene::Place& place : core::scene::places_of(read)) {
        if (!errors.empty()) return errors;
        const std::string pointer = core::scene::pointer_to(read, place);
        const Result<core::scene::Place> same = core::scene::find_place(meant, pointer);
        const double x = core::scene::value_at(read, place), y = same ? core::scene::value_at(meant, *same) : NAN;
        if (!(std::abs(x - y) <= rounding * std::max(1.0, std::abs(x))) && !(std::isnan(x) && same && std::isnan(y))) differs(pointer);
    }
    for (std::size_t i = 0; i < read.bodies.size(); ++i) {
        const Matrix3X &x = read.bodies[i].mesh.vertices, &y = meant.bodies[i].mesh.vertices;
        const bool same = read.bodies[i].mesh.triangles == meant.bodies[i].mesh.triangles && x.cols() == y.cols();
        if (!same || (x.size() > 0 && !((x - y).cwiseAbs().maxCoeff() <= rounding * (1 + x.cwiseAbs().maxCoeff()))))
            differs("/bodies/" + std::to_string(i));
    }
    return errors;
}

// The entry of `scenarios` that makes the scenario of this number: a "play" makes two.
const Json& entry_of(const Json& scenarios, int scenario) {
    std::size_t entry = 0;
    for (int k = 0;; ++entry) {
        k += scenarios[entry].contains("play") ? 2 : 1;
        if (scenario < k) return scenarios[entry];
    }
}

}  // namespace

Result<std::string> scene_text(const DesignFile& file, const std::string& path, const core::scene::ReadOptions& options, int scenario) {
    const Result<std::string> text = core::files::read_file(file.scene_path);
    if (!text) return text.errors();
    Json scene = Json::parse(*text);
    const Json design = Json::parse(file.text);
    for (const description::Choice& choice : file.choices) {
        const std::string& option = choice.options[static_cast<std::size_t>(choice.value)];
        if (choice.is_ordered)
            scene["variables"][choice.name] = Json::parse(option);
        else
            apply(design["choices"][choice.name]["options"][option], scene);
    }
    apply(design, scene);
    if (!file.design.scenarios.empty()) {
        const Json& entry = entry_of(design["scenarios"], scenario);
        apply(entry, scene);
        const Vector3& gravity = file.design.scenarios[static_cast<std::size_t>(scenario)].scene.gravity;
        if (entry.contains("play")) scene["gravity"] = {gravity[0], gravity[1], gravity[2]};  // with what presses
    }
    for (const description::Parameter& parameter : file.design.parameters)
        scene["variables"][parameter.name] = number_text(parameter.value, parameter.unit);
    if (design.contains("variables"))
        for (const auto& [name, value] : design["variables"].items())
            if (!name.starts_with("#")) scene["variables"][name] = value;
    move_names(scene, fs::path(file.scene_path).parent_path(), fs::path(path).parent_path());
    std::string out = core::files::dumped(scene, 2) + "\n";

    const auto problem = problem::DesignProblem::create(file.design);
    if (!problem) return problem.errors();
    const description::Design one = description::design_of_scenario(problem->design(), scenario);
    const auto meant = problem::move_scene(one, description::values_of(one.parameters), problem::SceneDerivative::not_wanted);
    if (!meant) return meant.errors();
    const Result<Scene> read = core::scene_files::parse_scene(out, path, options);
    if (!read) return read.errors();
    if (Errors errors = differences(*read, meant->scene, path); !errors.empty()) return errors;
    return out;
}

}  // namespace fettle::design::reading
