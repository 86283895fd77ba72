// SPDX-License-Identifier: MIT
/// The files that `fettle clearance` leaves: margins (--csv), the proof and the trajectory that it is about (--certificate), a folder with
/// the answer, meshes, path and report (--out). All that is asked for takes its place together, or nothing does.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/clearance/report.hpp"
#include "design/cli/command.hpp"

namespace fettle::design::cli {

struct ClearanceFiles {
    std::string judged;                 ///< file that was judged; a trajectory stays where it is
    std::string csv, certificate, out;  ///< empty: not wanted
    bool no_report = false;             ///< leave the folder's report.html out
    std::string scenario, process;      ///< for the certificate, of a design
};

/// What would be found out only after the work: files that cannot be written, or are somebody else's.
[[nodiscard]] Errors try_files(const ClearanceFiles& wanted);

/// Writes them, and adds what they are to the answer (`certificate`, `out`, `report`) and to the text for people. Where nothing is proven
/// an earlier certificate is taken away. Errors: a path that is not finite, a file that cannot be written; then answer, text and all files
/// are as they were before.
[[nodiscard]] Errors leave_files(const ClearanceFiles& wanted, const clearance::Subject& subject, clearance::ClearanceReport& report,
                                 const CommonOptions& common, Console& console, nlohmann::ordered_json& answer, std::string& told);

}  // namespace fettle::design::cli
