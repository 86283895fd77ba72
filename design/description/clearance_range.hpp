// SPDX-License-Identifier: MIT
/// What a clearance is asked over.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fettle::design::description {

struct ClearanceRange {
    int a = 0, b = 0;                               ///< bodies
    bool motion = false;                            ///< over the trajectory; false: as assembled, or over the ranges
    int window = 0, windows = 1;                    ///< which of how many equal parts of the motion, or of what `from` and `to` leave of it
    std::optional<double> from{}, to{};             ///< the part of the motion [s]: all steps of which some of the time lies within
    bool ranges = false;                            ///< over all positions of the joints (core/clearance/joint_ranges.hpp)
    std::vector<std::string> faces_a{}, faces_b{};  ///< names of faces that count alone; empty: the whole body
};

}  // namespace fettle::design::description
