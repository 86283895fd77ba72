// SPDX-License-Identifier: MIT
/// How much a file may place of what is in it, where one object can be placed many times. Real files stay far below.
#pragma once

#include <cstdint>

namespace fettle::core::mesh_files {

/// Vertices, triangles and edges of all that is placed.
inline constexpr std::uint64_t most_placed = 10'000'000;
/// Each placing of an object counts as so many more: those that it takes the time of.
inline constexpr std::uint64_t of_a_placing = 10;

}  // namespace fettle::core::mesh_files
