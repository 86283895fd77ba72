// SPDX-License-Identifier: MIT
/// What `fettle tolerance` answers, as JSON and for people. Keys: docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "design/description/requirement_text.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/tolerance_study.hpp"

namespace fettle::design::answers {

/// The answer of a study. @param design  As made. @param tolerances  That were studied.
nlohmann::ordered_json tolerance_json(const description::Design& design, const std::vector<description::Tolerance>& tolerances,
                                      const studies::ToleranceReport& report);

/// With the process that the file goes by, and what has no tolerance.
/// @param file  As made.
nlohmann::ordered_json tolerance_json(const reading::DesignFile& file, const studies::ToleranceReport& report);
/// The unit in which people read a response.
description::CountedUnit unit_of(const description::Design& design, const studies::Response& response);

/// @param process  That was asked for in place of the design's; empty: none.
std::string tolerance_text(const reading::DesignFile& file, const studies::ToleranceReport& report, const std::string& process = {});

}  // namespace fettle::design::answers
