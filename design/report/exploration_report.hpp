// SPDX-License-Identifier: MIT
/// The report of an exploration's file (`fettle explore --out FILE.jsonl`): FILE.report.html, to find a design in: the values that each
/// reaches, which ones no other one beats, how they look.
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "design/report/report_folder.hpp"

namespace fettle::design::report {

/// The design is the one that the file names, relative to the file's own folder; what it is needed for is left out, with a note, where it
/// is not there. A last line that was cut off is left out; lines that are none of a result are counted in a notice.
/// @param options  `motion` has no effect.
/// @return the path of the report. Errors: a file that cannot be read, is no exploration, or has no result; a FILE.report.html of another
/// program (one that `options.out` names is replaced).
Result<std::string> write_exploration_report(const std::string& file, const ReportOptions& options = {});

}  // namespace fettle::design::report
