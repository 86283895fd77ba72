// SPDX-License-Identifier: MIT
#include "fettle/design/cli/report_made.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "fettle/core/base/version.hpp"
#include "fettle/core/files/atomic_file.hpp"
#include "fettle/design/report/report_folder.hpp"

namespace fettle::design::cli {

using Json = nlohmann::ordered_json;

Errors write_result(const std::string& folder, Json answer, const CommonOptions& common) {
    answer["program"] = core::base::version();
    answer["command"] = common.command;
    const std::string text = answer.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    return core::files::write_file_atomically(std::filesystem::path(folder) / "result.json", text);
}

void leave_report(const std::string& folder, const CommonOptions& common, Console& console, Json& answer, std::string& told,
                  std::optional<report::Motion> motion) {
    console.narrate("making the report");
    report::ReportOptions options;
    options.mesh_dirs = common.mesh_dirs;
    options.fresh = true;
    options.motion = std::move(motion);
    options.should_stop = interrupted;
    const Result<std::string> made = report::write_report(folder, std::move(options));
    for (const Error& error : made.errors()) console.narrate("warning: no report: " + error.where + ": " + error.message);
    if (!made) return;
    answer["report"] = *made;
    told += "report: " + *made + "\n";
}

}  // namespace fettle::design::cli
