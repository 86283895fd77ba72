// SPDX-License-Identifier: MIT
/// What a mesh file says, before mesh_reader.cpp makes a geometry::Mesh of it, and the readers of single formats.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::mesh_files {

/// What the build of a 3MF places, or a solid of a STEP file: the vertices and polygons from these up to the next item's.
struct RawItem {
    std::string name;  ///< of its object; of a STEP file's no two are the same
    std::size_t first_vertex = 0, first_polygon = 0;
    std::optional<geometry::Deviation> deviation = {};  ///< [m]
    std::optional<std::array<unsigned char, 3>> colour = {};
};

struct RawMesh {
    std::vector<Vector3> vertices;      ///< in the file's unit; may be NaN or infinite
    std::vector<int> corners;           ///< vertex indices of all polygons, one after the other, 0-based
    std::vector<int> polygon_ends;      ///< per polygon: one past its last corner; at least 3 corners each
    std::vector<int> polygon_group;     ///< per polygon: index into `groups`, -1 for none
    std::vector<std::string> groups;    ///< objects of the file, as it names them
    std::vector<geometry::Edge> edges;  ///< polylines
    std::vector<int> points;            ///< vertices that the file names as points
    std::vector<RawItem> items;         ///< of 3MF and STEP; else empty: the file is one thing
    std::vector<int> polygon_face;      ///< of STEP, per polygon: index into `face_names`; else empty
    std::vector<std::string> face_names;
    double metres_per_unit = 0;  ///< 0: the file does not say
};

/// `where` is the path, for messages; lines are counted from 1. All vertex indices of the result are in range.
Result<RawMesh> parse_obj(std::string_view text, const std::string& where);
Result<RawMesh> parse_off(std::string_view text, const std::string& where);

/// `bytes`: the whole file. Sizes are bounded, and nothing that a file says about itself is taken on trust.
Result<RawMesh> parse_3mf(std::string_view bytes, const std::string& where);

Result<RawMesh> parse_stl(std::string_view bytes, const std::string& where);
Result<RawMesh> parse_ply(std::string_view bytes, const std::string& where);

/// What assimp makes of a file, in a process of its own with limits of time and memory (import_process.hpp).
/// @param extension    in lower case, with its dot: one of those that mesh_reader.hpp lists for assimp.
/// @param should_stop  optional: true ends it.
Result<RawMesh> read_by_assimp(const std::string& path, std::string_view extension, const std::function<bool()>& should_stop);

/// What Open CASCADE makes of a STEP file, likewise (core/step_importer).
/// @param chord, surface_tolerance  as MeshReadOptions
Result<RawMesh> read_step(const std::string& path, double chord, double surface_tolerance, const std::function<bool()>& should_stop);

/// Cuts a simple polygon into triangles with the same orientation (ear clipping, exact decisions in the projection along the largest
/// component of its normal). A convex polygon becomes the fan round its first corner, in time of the first order. Empty if the outline
/// crosses itself in that projection, or if the tests run out.
/// @param tests  How many corners may still be looked at; those that have been are taken off. Below 0: they have run out. A polygon that is
///               not convex takes of the second order in its number of corners, at most.
std::vector<geometry::Triangle> triangulated(const std::vector<Vector3>& vertices, const int* corners, int count, std::int64_t& tests);

}  // namespace fettle::core::mesh_files
