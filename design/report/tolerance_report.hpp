// SPDX-License-Identifier: MIT
/// The report of `fettle tolerance --report`: one HTML file, without scripts, that needs nothing else. It shows for each number that the
/// design asks for: what moves it (a tornado), how it came out in the samples (a histogram, with the prediction and the limits), how it
/// depends on the tolerance that moves it most (a scatter), and the answer's words on it. It has the colours and type of the other reports
/// (report_page.hpp).
#pragma once

#include <string>

#include "core/base/result.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/tolerance_study.hpp"

namespace fettle::design::report {

struct ToleranceReportSource {
    const reading::DesignFile& file;  ///< read as made, with the tolerances that were studied
    const studies::ToleranceReport& study;
    std::string answer = {};   ///< as the command told it
    std::string command = {};  ///< what was typed; empty: not known
};

std::string tolerance_page(const ToleranceReportSource& source);

/// Errors: a file that cannot be written.
Errors write_tolerance_report(const std::string& file, const ToleranceReportSource& source);

}  // namespace fettle::design::report
