// SPDX-License-Identifier: MIT
/// What `fettle tolerance` answers, as JSON and for people. Keys: docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fettle/design/studies/tolerance_study.hpp"

namespace fettle::design::answers {

/// @param design  As made.
nlohmann::ordered_json tolerance_json(const description::Design& design, const std::vector<description::Tolerance>& tolerances,
                                      const studies::ToleranceReport& report);

std::string tolerance_text(const description::Design& design, const std::vector<description::Tolerance>& tolerances,
                           const studies::ToleranceReport& report);

}  // namespace fettle::design::answers
