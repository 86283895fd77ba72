// SPDX-License-Identifier: MIT
/// Outlines of a part's file that are drawn one curve after another:
///     {"path": [[0, 0], [40, 0], {"to": [40, 10], "round": 2}, {"arc_to": [30, 20], "centre": [30, 10]}, [0, 20]]}
/// begins at its first point and closes itself. Steps:
///     [x, y]                    {"to": [x, y]}                       a line
///     {"arc_to": p, "centre": c, "clockwise": true}                   counter-clockwise if not said
///     {"arc_to": p, "through": q}   {"arc_to": p, "bulge": 1}         bulge: tan(a quarter of the arc's angle), 1 is a half circle
///     {"arc_to": p}                                                   goes on tangentially
///     {"arc_by": "90deg", "centre": c}
///     {"spline": [points]}          {"b_spline": [control points]}
///     {"law": {...}}                {"involute": ...}                 curve_reader.hpp; a line leads to them if they begin elsewhere
///     {"repeat": [steps], "count": 6, "about": c, "every": "60deg"}   turned on each time, by a full turn / count; or moved on by "step"
/// Steps may have "round" or "chamfer", of the corner at their end, and "name", the feature that they bound. Part of profile_reader.hpp.
#pragma once

#include <functional>
#include <string>

#include "core/part_files/part_numbers.hpp"
#include "core/parts/path.hpp"

namespace fettle::core::part_files {

using LoopMaker = std::function<Result<parts::Loop>(Sheet&)>;

/// The object that has the key `path`. @param name  The name of the feature that it bounds.
LoopMaker read_path(const files::JsonNode& node, PartNumbers& numbers, const std::string& name);

/// A list of points.
std::vector<PartPoint> read_points(const files::JsonNode& node, const PartNumbers& numbers, std::size_t fewest);
std::vector<parts::Point2> points_at(const std::vector<PartPoint>& points, const Sheet& sheet);

}  // namespace fettle::core::part_files
