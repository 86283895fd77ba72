// SPDX-License-Identifier: MIT
/// Two bodies along their path segments, and which parts of their hierarchies come close there.
///
/// Boxes and primitives are separated along a fixed direction n at both ends of the segments. Each vertex stays within its chord deviation
/// (docs/method/collision.md#broad-phase, B0 = |w|^2 |X| / 8) of a straight line, and the separation min_a n.a - max_b n.b of points that
/// move straight is concave in time; so the lesser of both ends, less the deviations, bounds it over the whole segment: bodies that move
/// together stay apart. Boxes are never proven apart where a pose or a step is not finite.
#pragma once

#include <array>
#include <vector>

#include "fettle/core/geometry/body_hierarchy.hpp"
#include "fettle/core/kinematics/path.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::ccd {

/// Rounding of sums of some thirty products, relative to the sizes that enter them.
inline constexpr double search_rounding = 1e-14;

/// A body at the two ends of its segment.
struct SweptBody {
    const model::Body* body = nullptr;
    std::array<kinematics::Pose, 2> ends;
    double loss = 0;     ///< per metre of radius: B0, and the rounding of placed points (chord_deviation.hpp); infinite if not finite
    bool still = false;  ///< the two ends are the same
    /// How far its points within `radius` may leave the chords of their computed places in between, besides the rounding of positions, [m].
    double deviation(double radius) const { return loss * radius; }
};

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment);

/// Separating directions n at one end of the segments: those of both bodies' boxes at the start, the last two twice.
struct SweptAxes {
    using Numbers = std::array<double, 8>;  // of each direction
    std::array<Numbers, 3> a, b;            ///< components of n in the body's frame there
    std::array<Numbers, 3> abs_a, abs_b;    ///< their magnitudes
    Numbers offset;                         ///< n . (q_b - q_a)
};

struct SweptPair {
    const SweptBody *a = nullptr, *b = nullptr;
    double margin = 0;                 ///< nodes and primitives farther apart than this, besides deviations, do not matter [m]
    std::array<SweptAxes, 2> axes;     ///< at both ends
    double reach = 0, world_size = 0;  ///< of positions [m], for rounding: relative to one another, with radii; in the world
    const geometry::FlatFeatures *plane_a = nullptr, *plane_b = nullptr;  ///< whose plane edges are left out (plane_edges.hpp)
    double deviation(double radius_a, double radius_b) const { return a->deviation(radius_a) + b->deviation(radius_b); }
};

/// Contract: `a` and `b` outlive the result.
SweptPair swept_pair(const SweptBody& a, const SweptBody& b, double margin);

/// A node of the hierarchy of a and one of b.
using NodePair = std::array<int, 2>;

/// Pairs of leaves below `from` that may come close. If `most` > 0: stops as soon as that many pairs of nodes are at hand and returns
/// them, leaves or not.
std::vector<NodePair> close_nodes(const SweptPair& pair, NodePair from, std::size_t most = 0);

}  // namespace fettle::core::ccd
