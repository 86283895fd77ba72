// SPDX-License-Identifier: MIT
/// How a program that reads files in a process of its own (assimp_importer.cpp, core/step_importer) hands a mesh to import_answer.hpp
/// through a pipe: numbers as the machine has them.
#pragma once

#include <cstdint>
#include <string_view>

namespace fettle::core::mesh_files {

/// First of all; then, of a mesh, what the counts announce, in their order; of a failure, the reason up to the end of the pipe.
struct ImportHeader {
    std::uint64_t mark = 0;      ///< one of the marks below; anything else: it has come to nothing
    std::uint64_t vertices = 0;  ///< three doubles each
    std::uint64_t corners = 0;   ///< of all polygons: a vertex index, 32 bits
    std::uint64_t polygons = 0;  ///< one past the last corner, 32 bits; behind all of them the name of each, 32 bits
    std::uint64_t edges = 0;     ///< two vertex indices of 32 bits
    std::uint64_t points = 0;    ///< a vertex index of 32 bits
    std::uint64_t names = 0;     ///< a length of 32 bits and the characters
    /// 0 but for STEP: one ImportBody for each name; then each polygon's face, 32 bits, and the faces' names.
    std::uint64_t bodies = 0, faces = 0;
};

/// What a file places: the vertices and polygons from these up to the next one's, and how far they are from the solid
/// (geometry::Deviation).
struct ImportBody {
    std::uint64_t first_vertex = 0, first_polygon = 0;
    double out = 0, in = 0, declared = 0;  ///< [m]
    std::uint32_t is_proven = 0;
    std::uint32_t colour = 0;  ///< 0x1RRGGBB; 0: none
};
inline constexpr std::uint64_t import_is_mesh = 0x6873656d656c7466, import_is_failure = 0x6c696166656c7466;
/// Behind the last name: everything has been written.
inline constexpr std::uint64_t import_end = 0x646e65656c7466;

/// Exit codes of the importer.
inline constexpr int import_written = 0, import_failed = 1, import_out_of_memory = 2, import_misused = 3, import_too_large = 4;

}  // namespace fettle::core::mesh_files
