// SPDX-License-Identifier: MIT
/// The question of `fettle ranges`: from where to where the joints of a model are free, each by itself.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/answers/ranges_answer.hpp"
#include "design/clearance/pairs.hpp"

namespace fettle::design::clearance {

struct RangesQuestion {
    std::vector<std::string> joints;  ///< by name; empty: each that moves
    std::string ignore;               ///< pairs that are not looked at, as PairOptions has them
    std::optional<double> reach{};    ///< how far slides are looked at, either way [m]; nothing: the size of the scene
    core::clearance::FreeRangeOptions options;
    std::function<void(int done, int of)> on_joint{};  ///< optional
};

/// Contract: the model stays where it is as long as the answer. Errors: joints or pairs that are not there, with the nearest that is; what
/// joint_ranges refuses, each at the option or joint that it is about.
Result<answers::RangesAnswer> ask_ranges(const core::model::Model& model, const RangesQuestion& question);

}  // namespace fettle::design::clearance
