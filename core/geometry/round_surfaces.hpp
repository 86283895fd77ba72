// SPDX-License-Identifier: MIT
/// The smooth surfaces that the rectangles of a body's sides stand for (rounded_sides.hpp), as what contact needs of them: at each round
/// corner an arc about a centre line along the side, at a sharp one an arc of radius 0, between them planes.
///
/// The rounded section lies within the mesh's by up to the corners' height. Moved outward by the largest height of its convex corners, its
/// `cover`, it contains the mesh's: bodies whose covers are apart have meshes that are.
#pragma once

#include <array>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/mesh.hpp"
#include "core/geometry/rounded_sides.hpp"

namespace fettle::core::geometry {

struct RoundSurfaces {
    /// A corner of a side at its lower (0) or upper (1) end.
    struct Place {
        int side = 0, corner = 0, end = 0;
    };
    struct Side {
        Vector3 across_1, across_2;    ///< with the axis right-handed and orthonormal
        std::vector<Vector2> normals;  ///< [rectangle] outward, along across_1 and across_2
        std::vector<double> lengths;   ///< [rectangle] from corner to corner [m]
        std::vector<double> tangents;  ///< [corner] how much of both rectangles its arc takes; 0 of a sharp one [m]
        int first_centre = 0;          ///< of corner 0 at the lower end, into `centres`; then upper, then the next corner
        int cover_corner = -1;         ///< the one whose height at the lower end is the cover; -1: the cover is 0
        double cover = 0;              ///< [m]
        bool is_circle = false;        ///< closed, and all arcs have one centre line
    };

    RoundedSides mesh_sides;
    std::vector<Side> sides;    ///< as mesh_sides.sides
    Matrix3X centres;           ///< 3 x n; of a sharp corner the vertex itself [m]
    std::vector<double> radii;  ///< [centre], 0 or more [m]
    std::vector<Place> places;  ///< [centre]
    double largest_height = 0;  ///< of a corner: how far a surface and its mesh are from each other [m]

    bool any() const;  ///< is something round?
    int centre(int side, int corner, int end) const { return sides[side].first_centre + 2 * corner + end; }
    /// The corner's neighbours and itself at that end, as vertices of the mesh. Contract: the corner is round.
    std::array<int, 3> vertices_of(const Place& place) const;
};

RoundSurfaces round_surfaces(const Mesh& mesh);

}  // namespace fettle::core::geometry
