// SPDX-License-Identifier: MIT
/// Where the convex hulls of two bodies, or of pieces of them, are nearest: along that direction one bound of both is as good as any of
/// their parts, so that bodies beside each other need no search of all the pairs of parts that are nearly as near.
///
/// For a vector n with |n| <= 1, dist >= n.p + min over A of n.(R X) - max over B of n.Z: a difference of support functions, both found by
/// descending a tree of boxes. The n for which it is largest is that of the hulls' closest points, which Gilbert, Johnson and Keerthi's
/// method finds: among the points of both bodies furthest along earlier directions, at most four pairs with the closest points between
/// them. Any n gives a true bound, so nothing depends on how far that came. Rounding is that of a bound of boxes or elements.
#pragma once

#include <array>

#include "core/clearance/piece_tree.hpp"
#include "core/clearance/relative_chain.hpp"

namespace fettle::core::clearance {

/// The point of a tree's corners that is furthest along a direction.
struct Support {
    const PieceElement* element = nullptr;
    int corner = 0;
    double value = 0;  ///< direction.X; NaN if that is no number somewhere

    Vector3 point() const { return element->corners.x.col(corner); }
};
inline Support any_support(const PieceTree& tree, int piece = 0) { return {&tree.elements[tree.pieces[piece].first], 0, 0}; }
/// The direction of the corners of a piece; 0: all.
/// @param guess  one of them to begin with: the nearer to the answer, the faster
Support support(const PieceTree& tree, const Vector3& direction, const Support& guess, int piece = 0);

class HullDirection {
public:
    HullDirection(const PieceTree& a, const PieceTree& b, int piece_a = 0, int piece_b = 0);

    struct Bound {
        Vector3 n = Vector3::Zero();  ///< |n| <= 1; zero where the hulls meet
        double apart = 0;             ///< along n, but for rounding, which is not charged here
    };
    /// Ends when the hulls' distance is known to `tolerance`. Begins where they were nearest in the pose before.
    Bound at(const RelativePose& pose, double tolerance);
    /// Ends when the hulls are found nearer than `distance`, or the bound exceeds it by half of what theirs does. Begins along `n`.
    Bound beyond(const RelativePose& pose, const Vector3& n, double distance);
    /// One of the nearest elements there, or next to them.
    int element_a() const { return static_cast<int>(simplex_[0].a.element - a_.elements.data()); }
    int element_b() const { return static_cast<int>(simplex_[0].b.element - b_.elements.data()); }

private:
    struct Vertex {
        Support a, b;
        Vector3 difference;  // R X + p - Z
    };

    Vector3 reduce();
    Vertex furthest(const RelativePose& pose, const Vector3& n, const Vertex& guess) const;
    template <class IsDone>
    Bound approach(const RelativePose& pose, const IsDone& is_done);

    const PieceTree &a_, &b_;
    int piece_a_, piece_b_;
    std::array<Vertex, 4> simplex_;
    int count_ = 1;
};

}  // namespace fettle::core::clearance
