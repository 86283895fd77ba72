// SPDX-License-Identifier: MIT
/// Where along a segment two elements are closest, to rounding: makes the witness of a certificate exact in time. Proves nothing.
#pragma once

#include "core/clearance/element_pair.hpp"
#include "core/clearance/pair_clearance.hpp"
#include "core/clearance/piece_tree.hpp"
#include "core/clearance/segment_bound.hpp"

namespace fettle::core::clearance {

/// Two elements at an instant.
struct Encounter {
    int segment = -1;  ///< of the list searched
    double s = 0;
    int element_a = 0, element_b = 0;  ///< of the piece trees
    ElementPairDistance pair;          ///< points relative to body b's reference point
};

/// Distance of two elements (corners in their bodies' frames) at an instant; points relative to body b's reference point.
/// @param before  as of element_pair_distance()
ElementPairDistance placed_distance(const Instant& at, const Corners& corners_a, const Corners& corners_b,
                                    const ElementPairDistance* before = nullptr);

/// The local minimum of the distance next to `s`, in [0, 1], by bisection of its derivative in s, n.(velocity of a's closest point - that
/// of b's), n from b to a: an end, or a place where that changes sign.
double least_distance_near(const PairSegment& segment, const Corners& corners_a, const Corners& corners_b, double s);

/// The encounter at the local minimum next to it, if that is as near up to rounding; else the encounter itself.
Encounter refined(const PairSegment& segment, const PieceTree& a, const PieceTree& b, const Encounter& encounter);

/// The features and points of two elements, as a witness of no instant.
Witness witness_between(const PieceTree& a, const PieceTree& b, int element_a, int element_b, const ElementPairDistance& found);

/// Index into the mesh of the primitive that takes part. Looks through all edges for an edge.
int primitive_index(const PieceTree& tree, int element, Primitive kind, int corner);

}  // namespace fettle::core::clearance
