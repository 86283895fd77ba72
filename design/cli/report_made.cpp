// SPDX-License-Identifier: MIT
#include "design/cli/report_made.hpp"

#include <nlohmann/json.hpp>

#include "design/answers/run_folder.hpp"
#include "design/cli/inputs.hpp"

namespace fettle::design::cli {

using Json = nlohmann::ordered_json;

void leave_report(const std::string& folder, const CommonOptions& common, Console& console, Json& answer, std::string& told,
                  report::AtHand at_hand) {
    console.narrate("making the report");
    report::ReportOptions options;
    options.mesh_dirs = common.mesh_dirs;
    options.programs = programs_of(common);
    at_hand.answer = answers::result_json(answer, common.command);
    options.at_hand = std::move(at_hand);
    options.should_stop = interrupted;
    const Result<std::string> made = report::write_report(folder, std::move(options));
    if (!made) {
        const Error& fault = made.errors().front();
        answer["report"] = nullptr;
        answer["report_fault"] = fault.where + ": " + fault.message;
        told += "no report: " + answer["report_fault"].get<std::string>() + "\n";
        if (fault.code == ErrorCode::file_unwritable) console.unwritten(made.errors());
        return;
    }
    answer["report"] = *made;
    told += "report: " + *made + "\n";
}

}  // namespace fettle::design::cli
