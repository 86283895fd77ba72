// SPDX-License-Identifier: MIT
/// Lower bounds of the distance of two pieces that turn about one axis and slide along it, or turn about one point
/// (certificate::Revolution): in closed form over all turns and tilts, and over a box of slides. A sphere in its socket, a pin in its bore,
/// a cone in its seat.
///
/// With r(x) a point's distance from the axis and z(x) how far along the axis it is, x -> (r, z) takes no two points farther apart, and
/// turns leave it as it is. So for a vector m of length <= 1,
///   dist >= min over B of (m_r r + m_z z)  -  max over A of (m_r r + m_z z)  +  the least of m_z (z that B has slid - z that A has),
/// and of the turns about one point the same with r the distance from it, and z = 0. r is convex: its largest value over an element is at a
/// corner, and where the least is wanted r(x) >= e . (x - p), e the direction to the element's point nearest to the axis, stands for it; of
/// a facet of a cylinder, a cone or a sphere about the axis that is the least value itself. An element has three numbers a corner for it,
/// (that value, r, z); a piece the least values along 16 vectors, and, of few elements, along the normals of its elements' profiles.
#pragma once

#include <array>
#include <vector>

#include "core/clearance/range_bound.hpp"

namespace fettle::core::clearance {

class RevolvedBound {
public:
    /// Contract: the pair has a revolution.
    explicit RevolvedBound(const ScrewedPair& pair);

    struct Found {
        double lower = 0;                   ///< slack charged
        Vector3 vector = Vector3::UnitX();  ///< (m_r, m_z, 0)
    };
    /// @param a, b  pieces of the two bodies
    Found bound(int a, int b, const CoordinateBox& box) const;

private:
    static constexpr std::size_t directions = 16;
    struct Corner {
        double low = 0, r = 0, z = 0;
    };
    struct Plane {
        double r = 0, z = 0;
    };
    struct Side {
        const PieceTree& tree;
        std::vector<std::array<Corner, 3>> elements;
        std::vector<std::array<double, directions>> least;  // of each piece, along the fixed vectors
    };
    struct Slides {
        double least = 0, most = 0;  // of z that b has slid, less what a has
    };

    static Plane fixed(std::size_t direction);
    static double least_along(const Plane& m, const Corner& corner);
    static double least_along(const Plane& m, const Side& side, const Piece& piece);
    static void add_normals(const std::array<Corner, 3>& element, std::vector<Plane>& out);
    Side side_of(const PieceTree& tree, const kinematics::Pose& start) const;
    std::array<Corner, 3> profile(const Corners& element, const kinematics::Pose& start) const;
    Slides slides_over(const CoordinateBox& box) const;

    const ScrewedPair& pair_;
    const certificate::Revolution& about_;
    const double length_;  // of the axis
    const Side a_, b_;
};

}  // namespace fettle::core::clearance
