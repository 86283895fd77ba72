// SPDX-License-Identifier: MIT
#include "fettle/design/answers/run_folder.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/design/exports/glb_writer.hpp"

namespace fettle::design::answers {

using Json = nlohmann::ordered_json;

Errors write_result(const std::string& folder, Json answer, const std::string& command) {
    answer["program"] = core::base::version();
    answer["command"] = command;
    const std::string text = answer.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    return core::files::write_file_atomically(std::filesystem::path(folder) / "result.json", text);
}

void forget_answer(const std::string& folder) {
    std::error_code ignored;
    for (const char* name : {"result.json", "report.html"}) std::filesystem::remove(std::filesystem::path(folder) / name, ignored);
}

void forget_motion(const std::string& folder) {
    forget_answer(folder);
    std::error_code ignored;
    for (const char* name : {"motion.glb", "trajectory.start.json", "steps.csv", "contacts.csv", "drives.csv", "joints.csv"})
        std::filesystem::remove(std::filesystem::path(folder) / name, ignored);
}

Errors write_animation(const std::string& folder, const core::model::Model& model, const core::stepper::Trajectory& trajectory) {
    return core::files::write_file_atomically(std::filesystem::path(folder) / "motion.glb",
                                              exports::glb_bytes(exports::assembly_of(model, trajectory)));
}

}  // namespace fettle::design::answers
