// SPDX-License-Identifier: MIT
/// Where the convex hulls of two bodies are nearest: along that direction one bound of both whole bodies is as good as any of their parts,
/// so that bodies beside each other need no search of all the pairs of parts that are nearly as near.
///
/// For a vector n with |n| <= 1, dist >= n.p + min over A of n.(R X) - max over B of n.Z: a difference of support functions, both found by
/// descending a tree of boxes. The n for which it is largest is that of the hulls' closest points, which Gilbert, Johnson and Keerthi's
/// method finds: among the points of both bodies furthest along earlier directions, at most four pairs with the closest points between
/// them. Any n gives a true bound, so nothing depends on how far that came. Rounding is that of a bound of boxes or elements.
#pragma once

#include <array>

#include "fettle/core/clearance/piece_tree.hpp"
#include "fettle/core/clearance/relative_chain.hpp"

namespace fettle::core::clearance {

/// The point of a tree's corners that is furthest along a direction.
struct Support {
    const PieceElement* element = nullptr;
    int corner = 0;
    double value = 0;  ///< direction.X; NaN if that is no number somewhere

    Vector3 point() const { return element->corners.x.col(corner); }
};
inline Support any_support(const PieceTree& tree) { return {tree.elements.data(), 0, 0}; }
/// @param guess  a point to begin with: the nearer to the answer, the faster
Support support(const PieceTree& tree, const Vector3& direction, const Support& guess);

/// As good a bound as the tolerance of a search asks for: this much of it.
inline constexpr double hull_gap = 0.1;

/// Follows the hulls' closest points from one pose to the next.
class HullDirection {
public:
    HullDirection(const PieceTree& a, const PieceTree& b);

    struct Bound {
        Vector3 n = Vector3::Zero();  ///< |n| <= 1; zero where the hulls meet
        double apart = 0;             ///< along n, but for rounding, which is not charged here
    };
    /// Ends when the hulls' distance is known to `tolerance`.
    Bound at(const RelativePose& pose, double tolerance);

private:
    struct Vertex {
        Support a, b;
        Vector3 difference;  // R X + p - Z
    };

    Vector3 reduce();

    const PieceTree &a_, &b_;
    std::array<Vertex, 4> simplex_;
    int count_ = 1;
};

}  // namespace fettle::core::clearance
