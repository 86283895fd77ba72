// SPDX-License-Identifier: MIT
/// An assembly for ParaView and VTK: one unstructured grid for an instant (.vtu), a collection of them over time (.pvd).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "design/exports/assembly.hpp"

namespace fettle::design::exports {

/// All parts at one keyframe, in the world [m]: points as Float64; cells: triangles, loose edges, loose points. Cell data `part` (number of
/// the part, from 0; field data `part_names` has the names, one after the other with a line feed between). Point data `displacement`
/// since the first keyframe [m]. Appended raw, compressed by zlib.
std::string vtu_bytes(const Assembly& assembly, const Keyframe& keyframe);

/// @param frames  time [s] and file name of each, relative to the collection.
std::string pvd_text(const std::vector<std::pair<double, std::string>>& frames);

}  // namespace fettle::design::exports
