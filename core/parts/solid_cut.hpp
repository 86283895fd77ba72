// SPDX-License-Identifier: MIT
/// How two closed meshes cut each other, and where every vertex and triangle of their combination is from. Exact, on plain numbers.
/// Parts use no coordinate of it, so that vertices can be computed on recorded numbers (solid_booleans.hpp).
#pragma once

#include <array>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/mesh.hpp"
#include "core/parts/arrangement.hpp"
#include "core/parts/flat_faces.hpp"

namespace fettle::core::parts {

struct VertexOrigin {
    enum class Kind {
        vertex_of_a,
        vertex_of_b,
        edge_of_a,  ///< where an edge of a goes through a triangle of b
        edge_of_b
    };
    Kind kind = Kind::vertex_of_a;
    int from = 0, to = 0;  ///< the vertex (both); or the ends of the edge, the smaller one first
    int triangle = 0;      ///< of the other mesh
    /// Where the edge lies in the plane of the triangle it crosses a side of it instead: from corner `side` to the next; -1: it goes
    /// through.
    int side = -1;
};

struct CutTriangle {
    std::array<int, 3> corners{};  ///< indices of SolidCut::vertices, counter-clockwise from outside of the combination
    bool of_a = true;
    int triangle = 0;  ///< that it is a part of
};

struct SolidCut {
    std::vector<VertexOrigin> vertices;
    std::vector<Vector3> points;  ///< of the vertices, rounded; empty of a cut that was written down
    std::vector<CutTriangle> triangles;
};

/// Whether this build can cut: CGAL was there when it was configured.
bool can_cut_solids();

/// Corners of flat faces are taken to be where the faces' planes meet, exactly (flat_faces.hpp); no farther than `rounding` from where they
/// are given. Contract: both are outward oriented, without self-intersection. Errors: unsupported without CGAL; results whose surface
/// touches itself along edges, which no mesh of a solid can say; surfaces that are not closed; `where` is empty.
Result<SolidCut> cut_solids(const FacedMesh& a, const FacedMesh& b, double rounding, Combination combination);

}  // namespace fettle::core::parts
