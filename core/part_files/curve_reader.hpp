// SPDX-License-Identifier: MIT
/// Curves of a part's file that are not lines and arcs:
///     {"law": {"t": [0, "360deg"], "x": "= a * cos(t)", "y": "= b * sin(t)"}}            or "radius" and "angle" in place of x and y
///     {"involute": "= base", "from": "= root", "to": "= tip", "turn": "= -half"}         of the circle of radius `base`, between two radii
/// Part of profile_reader.hpp.
#pragma once

#include <functional>
#include <string>

#include "core/part_files/part_numbers.hpp"
#include "core/parts/curve.hpp"

namespace fettle::core::part_files {

using CurveMaker = std::function<parts::LawCurve(Sheet&)>;

/// The value of `law`.
CurveMaker read_law(const files::JsonNode& node, PartNumbers& numbers);
/// The object that has the key `involute`, of which other keys may be its step's.
CurveMaker read_involute(const files::JsonNode& node, const PartNumbers& numbers);

}  // namespace fettle::core::part_files
