// SPDX-License-Identifier: MIT
/// What commands with --out leave for people beside what they leave for programs (answers/run_folder.hpp).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/design/cli/session.hpp"
#include "fettle/design/report/report_data.hpp"

namespace fettle::design::cli {

/// Makes FOLDER/report.html, tells of it in `answer` (`report`) and at the end of `told`. One that cannot be made is told there with
/// the reason (`report` null, `report_fault`): the results are there. Once a stop has been asked for, what takes computing is left out.
/// @param motion  of the folder's trajectory, with its scene's path, if at hand.
void leave_report(const std::string& folder, const CommonOptions& common, Console& console, nlohmann::ordered_json& answer,
                  std::string& told, std::optional<report::Motion> motion = std::nullopt);

}  // namespace fettle::design::cli
