// SPDX-License-Identifier: MIT
/// Meshes as files that other programs read: STL, OBJ, 3MF, lengths in millimetres. Reading: mesh_reader.hpp.
///
/// Precision. OBJ and 3MF hold decimal numbers that read back to the same double where one does, else to its neighbour: what they lose is
/// below 3e-16 of a coordinate. Binary STL holds float32 by definition: 6e-8 of a coordinate, which `stl_rounding` returns.
/// What a format cannot hold is left out: STL and 3MF have triangles only, so that a part without triangles is not in them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::mesh_files {

/// Red, green, blue.
using Colour = std::array<unsigned char, 3>;

/// A part on its way to a file. The mesh outlives it.
struct MeshPart {
    std::string name;
    const geometry::Mesh* mesh = nullptr;  ///< [m], in the part's own frame
    Colour colour{128, 128, 128};
    Matrix3 rotation = Matrix3::Identity();  ///< a point x of the mesh is at rotation * x + position
    Vector3 position = Vector3::Zero();      ///< [m]
};

/// Binary STL of all parts, placed, one solid after the other; its 80 bytes of header name the unit.
std::string stl_bytes(const std::vector<MeshPart>& parts);
/// How far rounding to float32 moves a vertex of `stl_bytes` [m].
double stl_rounding(const std::vector<MeshPart>& parts);

/// OBJ, placed, one `o` for each part; loose edges as `l`, loose points as `p`. Spaces in names become `_`.
/// @param materials  file that `mtllib` names (`mtl_text`); empty: none, and no colours.
std::string obj_text(const std::vector<MeshPart>& parts, const std::string& materials = {});
/// The colours of `obj_text`, one material for each part, called as it is there.
std::string mtl_text(const std::vector<MeshPart>& parts);

/// 3MF (core specification 1.3): an object for each part, with its name and colour, in its own frame, and a build item that places it. A
/// mesh that is no closed surface goes in as a `surface`, which slicers do not fill.
/// Errors: mesh_invalid (no part has a triangle).
Result<std::string> threemf_bytes(const std::vector<MeshPart>& parts);

}  // namespace fettle::core::mesh_files
