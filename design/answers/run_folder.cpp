// SPDX-License-Identifier: MIT
#include "fettle/design/answers/run_folder.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/core/files/json_keys.hpp"
#include "fettle/design/exports/glb_writer.hpp"

namespace fettle::design::answers {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t head = 256;                          // bytes, in which a report says who made it
constexpr std::string_view made_by_us = "Made by fettle";  // of report/web/index.html

bool is_anothers(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return false;
    if (file.extension() == ".json") return !core::files::has_top_level_key(file, "status");
    std::string text(head, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(head));
    return text.find(made_by_us) == std::string::npos;
}

}  // namespace

Errors others_files(const std::filesystem::path& folder) {
    Errors errors;
    for (const char* name : {"report.html", "result.json"}) {
        if (!is_anothers(folder / name)) continue;
        errors.push_back({ErrorCode::inconsistent, (folder / name).string(),
                          "is there and was not written by fettle: it would be replaced; name another folder, or move it away"});
    }
    return errors;
}

Errors add_result(core::files::FilesTogether& files, const std::string& folder, Json answer, const std::string& command) {
    answer["program"] = core::base::version();
    answer["command"] = command;
    const std::string text = answer.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    return files.add(std::filesystem::path(folder) / "result.json", text);
}

void replace_answer(core::files::FilesTogether& files, const std::string& folder) {
    for (const char* name : {"result.json", "report.html"}) files.take_away(std::filesystem::path(folder) / name);
}

void replace_motion(core::files::FilesTogether& files, const std::string& folder) {
    replace_answer(files, folder);
    for (const char* name : {"motion.glb", "trajectory.start.json", "steps.csv", "contacts.csv", "drives.csv", "joints.csv"})
        files.take_away(std::filesystem::path(folder) / name);
}

Errors add_animation(core::files::FilesTogether& files, const std::string& folder, const core::model::Model& model,
                     const core::stepper::Trajectory& trajectory) {
    return files.add(std::filesystem::path(folder) / "motion.glb", exports::glb_bytes(exports::assembly_of(model, trajectory)));
}

}  // namespace fettle::design::answers
