// SPDX-License-Identifier: MIT
/// What `fettle tolerance --allocate` answers, as JSON and for people. Keys: docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "design/studies/allocation.hpp"

namespace fettle::design::answers {

/// @param design  As made. @param given  The tolerances as they stood.
nlohmann::ordered_json allocation_json(const description::Design& design, const std::vector<description::Tolerance>& given,
                                       const studies::AllocationOptions& options, const studies::AllocationReport& report);

std::string allocation_text(const description::Design& design, const std::vector<description::Tolerance>& given,
                            const studies::AllocationOptions& options, const studies::AllocationReport& report);

}  // namespace fettle::design::answers
