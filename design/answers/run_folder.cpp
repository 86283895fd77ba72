// SPDX-License-Identifier: MIT
#include "design/answers/run_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_dump.hpp"
#include "core/files/json_keys.hpp"
#include "core/records/trajectory_io.hpp"
#include "design/exports/glb_writer.hpp"

namespace fettle::design::answers {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t head = 256;  // bytes, in which a file says who made it

// What a file has there that is written by us: a report (of report/web/index.html), animated parts, a table (records/step_tables.hpp).
std::string_view mark_of(const std::string& name) {
    if (name == "motion.glb") return "\"generator\":\"fettle ";
    if (name == "steps.csv") return "time,kinetic_energy,";
    if (name == "contacts.csv") return "time,a,b,";
    if (name == "drives.csv") return "time,body,fx,";
    if (name == "joints.csv") return "time,name,fx,";
    return "Made by fettle";
}

bool is_ours(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    if (name == "design.final.json") return core::files::has_top_level_key(file, "fettle_design");
    if (name == "result.json") return core::files::has_top_level_key(file, "status");
    if (file.extension() == ".json") return core::records::is_trajectory_file(file);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return true;
    std::string text(head, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(head));
    return text.find(mark_of(name)) != std::string::npos;
}

constexpr std::string_view scenario_prefix = "trajectory.scenario.";

// As JSON is written.
void without_infinities(Json& json) {
    if (json.is_number_float() && !std::isfinite(json.get<double>())) json = nullptr;
    if (json.is_structured())
        for (Json& member : json) without_infinities(member);
}

}  // namespace

std::string scenario_trajectory(const std::string& scenario) {
    std::string name;
    for (const char c : scenario) {
        constexpr std::string_view no_part_of_a_name = "/\\:*?\"<>|%";
        const bool fits = static_cast<unsigned char>(c) >= 0x20 && no_part_of_a_name.find(c) == std::string_view::npos;
        name += fits ? std::string(1, c) : core::base::formatted("%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    return std::string(scenario_prefix) + name + ".json";
}

Errors others_file(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored) || is_ours(file)) return {};
    return {{ErrorCode::inconsistent, file.string(),
             "is there and was not written by fettle: it would be replaced; write elsewhere, or move it away"}};
}

Errors others_files(const std::filesystem::path& folder, const std::vector<std::string>& more) {
    std::vector<std::string> names{"report.html",  "result.json", "trajectory.json", "trajectory.start.json", "motion.glb", "steps.csv",
                                   "contacts.csv", "drives.csv",  "joints.csv"};
    names.insert(names.end(), more.begin(), more.end());
    Errors errors;
    for (const std::string& name : names) {
        const Errors found = others_file(folder / name);
        errors.insert(errors.end(), found.begin(), found.end());
    }
    return errors;
}

Json result_json(Json answer, const std::string& command) {
    answer["program"] = core::base::version();
    answer["command"] = command;
    without_infinities(answer);
    return answer;
}

Errors add_result(core::files::FilesTogether& files, const std::string& folder, Json answer, const std::string& command) {
    const std::string text = core::files::dumped(result_json(std::move(answer), command), 2) + "\n";
    return files.add(std::filesystem::path(folder) / "result.json", text);
}

void replace_answer(core::files::FilesTogether& files, const std::string& folder) {
    for (const char* name : {"result.json", "report.html"}) files.take_away(std::filesystem::path(folder) / name);
}

void replace_motion(core::files::FilesTogether& files, const std::string& folder) {
    replace_answer(files, folder);
    for (const char* name : {"motion.glb", "trajectory.start.json", "steps.csv", "contacts.csv", "drives.csv", "joints.csv"})
        files.take_away(std::filesystem::path(folder) / name);
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(scenario_prefix) && name.ends_with(".json") && core::records::is_trajectory_file(entry.path()))
            files.take_away(entry.path());
    }
}

Errors add_animation(core::files::FilesTogether& files, const std::string& folder, const core::model::Model& model,
                     const core::stepper::Trajectory& trajectory) {
    return files.add(std::filesystem::path(folder) / "motion.glb", exports::glb_bytes(exports::assembly_of(model, trajectory)));
}

Errors add_outcome(core::files::FilesTogether& files, const std::string& folder, const problem::DesignEvaluation& final, const Json& answer,
                   const std::string& command) {
    replace_motion(files, folder);
    Errors errors =
        final.usable ? add_animation(files, folder, *final.runs.front().model, final.runs.front().simulation.trajectory) : Errors{};
    return errors.empty() ? add_result(files, folder, answer, command) : errors;
}

}  // namespace fettle::design::answers
