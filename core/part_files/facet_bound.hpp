// SPDX-License-Identifier: MIT
/// How many facets a part asks for, known before any of its solids is drawn: patterns of patterns and unions of unions multiply, and
/// drawing them up to the limit takes seconds. Solids are walked through as solid_reader.hpp draws them, each as a count from below and a
/// box that holds it:
/// - what is extruded, revolved, twisted: the facets of the outline's curves, times the segments of the turn;
/// - copies: as many times as much;
/// - a union has all facets of those whose boxes are apart from the boxes of all others; of others, as of cuts, nothing is counted that a
///   cut may take away. So a part that is refused here would have been refused as it was drawn.
/// Part of part_file.hpp.
#pragma once

#include <functional>

#include "core/part_files/solid_reader.hpp"

namespace fettle::core::part_files {

/// The least number of facets of a part; or, where the part, or anything that it is cut from, asks for more facets than are drawn, an error
/// that says where, how many and what to do. 0 of what cannot be drawn. It draws outlines on a sheet of its own.
using FacetBound = std::function<Result<double>(const Sheet& sheet)>;

/// Reads the bound of the part that is `solid`, in a file that has been read without a fault.
/// @param numbers, profiles  as SolidReader had them
/// @param named              `solids` of the file
FacetBound read_facet_bound(PartNumbers& numbers, ProfileReader& profiles, const files::JsonNode& named, const files::JsonNode& solid);

}  // namespace fettle::core::part_files
