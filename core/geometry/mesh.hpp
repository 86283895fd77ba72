// SPDX-License-Identifier: MIT
/// A triangle mesh (possibly with loose edges and points), as plain data. Reading: mesh_files/mesh_reader.hpp;
/// validity: solids/mesh_validity.hpp; mass: geometry/mass_moments.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::core::geometry {

using Edge = std::array<int, 2>;      ///< vertex indices
using Triangle = std::array<int, 3>;  ///< vertex indices, counter-clockwise seen from outside

/// How far a true part, whose round surfaces are round, and its mesh are from each other, as solids [m], rounding included:
///     every point of the part is within `out` of the mesh's solid, every point of the mesh's solid within `in` of the part.
/// So   distance of meshes - out_a - out_b <= distance of the parts <= distance of meshes + in_a + in_b.
struct Deviation {
    double out = 0, in = 0;
    /// False: found from samples (curves of a law without bound), or of what solids cut each other by (parts/solid_booleans.hpp) to first
    /// order.
    bool out_is_proven = true, in_is_proven = true;
    /// The share of both that is no theorem but a file's word: tolerances that a STEP file declares for its edges and vertices.
    double declared = 0;

    void add(const Deviation& other) {
        out = std::max(out, other.out);
        in = std::max(in, other.in);
        out_is_proven = out_is_proven && other.out_is_proven;
        in_is_proven = in_is_proven && other.in_is_proven;
        declared = std::max(declared, other.declared);
    }
};

/// Connectivity is fixed for life; a shape parameter moves `vertices` only.
struct Mesh {
    std::string name;   ///< of the file or part, for messages
    Matrix3X vertices;  ///< 3 x n, one column a vertex [m], no two equal (exactly welded)
    std::vector<Triangle> triangles;
    std::vector<Edge> edges;                ///< every edge of the triangles once, then the codimensional edges
    std::vector<int> codimensional_points;  ///< vertices used by no edge
    std::vector<int> triangle_shell;        ///< per triangle: index of its edge-connected shell, 0-based, in order of first triangle
    std::vector<std::string> shell_names;   ///< one per shell
    /// Per triangle: index into `face_names`; empty: its faces have no names. Connectivity that is built anew leaves both as they are.
    std::vector<int> triangle_face;
    std::vector<std::string> face_names;  ///< the part's own: "bore", "rim end", "slot 2" (named_faces.hpp)
    /// From the part that it was drawn for (core/parts), or the solid of a STEP file; nothing: it is the part.
    std::optional<Deviation> deviation;
    std::optional<std::array<unsigned char, 3>> colour;  ///< sRGB, where its file has one (STEP)
};

/// The sides of the box round points, along the axes [m]. Contract: there is a point.
inline Vector3 box_sides(const Matrix3X& points) { return points.rowwise().maxCoeff() - points.rowwise().minCoeff(); }

/// Fills edges, codimensional_points, triangle_shell (and shell_names where it has the wrong length: "name/0", "name/1", ...)
/// from vertices and triangles. Edges appear in the order of their first triangle; `extra_edges` follow.
void build_connectivity(Mesh& mesh, const std::vector<Edge>& extra_edges = {});

/// A mesh from vertices and triangles, connectivity built. Vertices are taken as they are (no welding).
Mesh make_mesh(std::string name, Matrix3X vertices, std::vector<Triangle> triangles);

/// Have both the same vertices (to the bit, but for the sign of zero), triangles, edges and points, in the same order?
bool have_same_shape(const Mesh& a, const Mesh& b);

/// For each of many meshes the index of the first that has the same shape, its own if it is that: copies of a part share what is worked out
/// from it. On all threads.
std::vector<std::size_t> first_of_shape(const std::vector<const Mesh*>& meshes);

/// Merges vertices with exactly equal coordinates (-0 equals +0), drops triangles that become degenerate by index, and
/// rebuilds connectivity. Order of first occurrence is kept.
Mesh weld_exactly(const Mesh& mesh);

}  // namespace fettle::core::geometry
