// SPDX-License-Identifier: MIT
/// The folder that `fettle clearance --out` writes: the answer, the meshes and path that it is about, the report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "fettle/design/cli/session.hpp"
#include "fettle/design/report/report_data.hpp"

namespace fettle::design::cli {

/// Are all numbers of the path finite?
bool is_finite(const core::stepper::Trajectory& trajectory);

struct ClearanceFolder {
    std::string out;         ///< folder; empty: none is wanted, and nothing is written
    std::string judged;      ///< file that was judged: where it is the folder's own trajectory.json, that stays as it is
    bool no_report = false;  ///< leave report.html out
};

/// Adds `out` and `report` to the answer, and the report to the text for people. Errors: a path that is not finite, files that cannot be
/// written.
[[nodiscard]] Errors write_folder(const ClearanceFolder& folder, report::Motion motion, const CommonOptions& common, Console& console,
                                  nlohmann::ordered_json& answer, std::string& told);

}  // namespace fettle::design::cli
