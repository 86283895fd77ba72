// SPDX-License-Identifier: MIT
/// The answer of `ranges`: from where to where each joint is proven free, and the bodies that stop it. Keys: docs/interface.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/clearance/free_ranges.hpp"

namespace fettle::design::answers {

struct RangesAnswer {
    const core::model::Model& model;
    core::clearance::JointRanges ranges;  ///< of the model, with its limits
    std::vector<core::clearance::FreeRange> found;
    core::clearance::FreeRangeOptions asked;
    double reach = 0;                        ///< of slides [m]
    std::vector<std::string> not_looked_at;  ///< "a:b" of pairs that were left out, with the reason
    bool interrupted = false;
};

enum class RangesStatus {
    ok,         ///< the ends of all ranges are known
    clash,      ///< bodies that no joint joins are closer than the minimum as assembled
    undecided,  ///< an end is not known
};
RangesStatus status_of(const RangesAnswer& answer);
const char* to_string(RangesStatus status);

nlohmann::ordered_json ranges_json(const RangesAnswer& answer);
std::string ranges_text(const RangesAnswer& answer);

/// "free from -3.2 to 112.41 deg, proven": each end rounded to the inside of what is proven.
std::string range_sentence(const RangesAnswer& answer, const core::clearance::FreeRange& range);

}  // namespace fettle::design::answers
