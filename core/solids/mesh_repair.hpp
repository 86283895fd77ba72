// SPDX-License-Identifier: MIT
/// Mends errors of real mesh files that have one answer only: copies of a triangle, triangles that are turned over, solids that are inside
/// out. Nothing is moved, added or guessed; what is left is for mesh_validity.hpp to judge.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

/// - A triangle that stands in the list again, with the same three vertices in the same direction, is dropped.
/// - A shell whose edges are each in exactly two triangles, some of them the same way round, is oriented, if it is orientable: the fewer
///   triangles are turned.
/// - In a mesh that is closed then, a shell that is inside out (its volume is negative within an even number of others) is turned, and with
///   it the shells right within it that bound its cavities: a hollow solid is turned as a whole. Where shells cross only the sum of volumes
///   is judged, and all is turned.
/// Connectivity is built anew where anything changed; shell names stay where their number stays.
/// @return  What was done, one sentence each with number and place; empty: nothing, and `mesh` keeps its bits.
/// Contract: vertex indices in range, coordinates finite, connectivity built.
std::vector<std::string> repair_mesh(geometry::Mesh& mesh);

}  // namespace fettle::core::solids
