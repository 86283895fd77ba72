// SPDX-License-Identifier: MIT
/// The report of `fettle clearance` (clearance/report.hpp) for people, for continuous integration and for spreadsheets. Lengths in the
/// model's unit, lower bounds rounded down and upper ones up.
#pragma once

#include <string>
#include <vector>

#include "design/clearance/report.hpp"
#include "design/cli/console.hpp"

namespace fettle::design::cli {

/// Explains the `explain` worst pairs.
std::string report_text(const clearance::ClearanceReport& report, const clearance::Subject& subject, int explain, const Console& console);

/// Each pair as a check (finding_files.hpp), and that all was judged.
std::vector<Check> report_checks(const clearance::ClearanceReport& report, const clearance::Subject& subject, const std::string& file);

/// Over a path the margin curves, one row per pair of bodies and path segment:
///   a,b,step,segment,time_start[s],time_end[s],lower[unit],upper[unit]
/// Over ranges a row per pair, worst first, with the joints' positions where it is worst, empty where a joint moves neither against the
/// other:   a,b,required[unit],lower[unit],upper[unit],finding,JOINT[deg or unit]...
std::string report_csv(const clearance::ClearanceReport& report, const clearance::Subject& subject);

}  // namespace fettle::design::cli
