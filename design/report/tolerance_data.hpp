// SPDX-License-Identifier: MIT
/// The data of the page of `fettle tolerance --report`, as the page takes it: one JSON object, SI, beside the keys of report_data.hpp:
/// format, program, command, kind ("tolerance"), name, folder (the design's file), description, views (none), notices, files:
///   answer      the study's answer (answers/tolerance_json.hpp)
///   text        the answer as the command told it
///   responses   list, in the order of the answer's, of
///     scale       SI of one of its `unit`
///     required    text; null where nothing is required
///     effects     list, in the order of its contributions, of {at_lower, at_upper: its predicted change with that tolerance alone at its
///                 limits, shared: is it about what a group shares, at 3 standard deviations?}
///     predicted   f64: quantiles of the prediction over the tolerances, evenly from the least to the largest; empty: there is none
///     values, met  f64, u32: of each sample, NaN and 0 if it failed
///     contacts    texts: how the contacts of the sample farthest from its prediction differ from those as drawn
///   samples     u32: their numbers
///   deviations  list, in the order of the answer's tolerances: f64 of each sample, in its unit, if the tolerance moves a response most;
///               else null
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/base/result.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/tolerance_study.hpp"

namespace fettle::design::report {

struct ToleranceReportSource {
    const reading::DesignFile& file;  ///< read as made, with the tolerances that were studied
    const studies::ToleranceReport& study;
    std::string text = {};     ///< the answer as the command told it
    std::string command = {};  ///< what was typed; empty: not known
};

nlohmann::ordered_json tolerance_data(const ToleranceReportSource& source);

/// Writes the page. Errors: a file that cannot be written.
Errors write_tolerance_report(const std::string& file, const ToleranceReportSource& source);

}  // namespace fettle::design::report
