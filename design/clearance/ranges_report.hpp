// SPDX-License-Identifier: MIT
/// The one question of `fettle ranges`: from where to where the joints of a model are free, each by itself, and the bodies that stop them.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/clearance/free_ranges.hpp"
#include "design/clearance/pairs.hpp"

namespace fettle::design::clearance {

struct RangesQuestion {
    std::vector<std::string> joints;  ///< by name; empty: each that moves
    std::string ignore;               ///< pairs that are not looked at, as PairOptions has them
    std::optional<double> reach{};    ///< how far slides are looked at, either way [m]; nothing: the size of the scene
    core::clearance::FreeRangeOptions options;
    std::function<void(int done, int of)> on_joint{};  ///< optional
};

enum class RangesStatus {
    ok,         ///< the ends of all ranges are known
    clash,      ///< bodies that no joint joins are closer than the minimum as assembled
    undecided,  ///< an end is not known, or the search was interrupted
};
const char* to_string(RangesStatus status);  ///< "ok", "violated", "undecided"

struct RangesReport {
    const core::model::Model& model;
    core::clearance::JointRanges ranges;  ///< with the joints' limits, where they have any
    std::vector<core::clearance::FreeRange> found;
    core::clearance::FreeRangeOptions asked;
    double reach = 0;                        ///< of slides [m]
    std::vector<std::string> not_looked_at;  ///< "a:b" of pairs that were left out, with the reason
    bool interrupted = false;
};

/// Contract: the model stays where it is as long as the report. Errors: joints or pairs that are not there, with the nearest that is; what
/// joint_ranges refuses, each at the option or joint that it is about.
Result<RangesReport> ask_ranges(const core::model::Model& model, const RangesQuestion& question);

RangesStatus status_of(const RangesReport& report);
RangesStatus status_of(const core::clearance::FreeRange& range);

/// Keys: docs/interface.md. SI.
nlohmann::ordered_json ranges_json(const RangesReport& report);
/// Degrees and millimetres, each end rounded to the inside of what is proven.
std::string ranges_text(const RangesReport& report);
/// "free from -3.2 to 112.41 deg, proven".
std::string range_sentence(const RangesReport& report, const core::clearance::FreeRange& range);
/// The same as `limits` of a scene: "-3.2 deg", "112.41 deg". Nothing: the joint turns freely, is free nowhere, or is a ball's swing.
std::optional<std::pair<std::string, std::string>> proposed_limits(const RangesReport& report, const core::clearance::FreeRange& range);

}  // namespace fettle::design::clearance
