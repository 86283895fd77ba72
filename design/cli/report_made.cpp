// SPDX-License-Identifier: MIT
#include "fettle/design/cli/report_made.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/design/exports/glb_writer.hpp"
#include "fettle/design/report/report_folder.hpp"

namespace fettle::design::cli {

using Json = nlohmann::ordered_json;

Errors write_result(const std::string& folder, Json answer, const CommonOptions& common) {
    answer["program"] = core::base::version();
    answer["command"] = common.command;
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

void leave_report(const std::string& folder, const CommonOptions& common, Console& console, Json& answer, std::string& told,
                  std::optional<report::Motion> motion) {
    console.narrate("making the report");
    report::ReportOptions options;
    options.mesh_dirs = common.mesh_dirs;
    options.motion = std::move(motion);
    options.should_stop = interrupted;
    const Result<std::string> made = report::write_report(folder, std::move(options));
    for (const Error& error : made.errors()) console.narrate("warning: no report: " + error.where + ": " + error.message);
    if (!made) return;
    answer["report"] = *made;
    told += "report: " + *made + "\n";
}

}  // namespace fettle::design::cli
