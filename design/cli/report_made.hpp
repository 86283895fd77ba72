// SPDX-License-Identifier: MIT
/// The files that commands with --out leave for people beside those they leave for programs (answers/run_folder.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/base/result.hpp"
#include "design/cli/command.hpp"
#include "design/report/report_folder.hpp"

namespace fettle::design::cli {

/// Makes FOLDER/report.html, names it in `answer` (`report`) and at the end of `told`. If it cannot be made, both say so with the
/// reason (`report` null, `report_fault`): the results are there. Once a stop has been asked for, what takes computing is left out.
/// @param answer   that is in the folder
/// @param at_hand  whatever else is
void leave_report(const std::string& folder, const CommonOptions& common, Console& console, nlohmann::ordered_json& answer,
                  std::string& told, report::AtHand at_hand);

}  // namespace fettle::design::cli
