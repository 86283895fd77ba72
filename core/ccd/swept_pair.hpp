// SPDX-License-Identifier: MIT
/// Two bodies along their path segments: how far their points may be from where both ends of the segments have them.
///
/// Primitives are separated along a fixed direction n at both ends of the segments. Each vertex stays within its chord deviation
/// (docs/method/collision.md#broad-phase, B0 = |w|^2 |X| / 8) of a straight line, and the separation min_a n.a - max_b n.b of points that
/// move straight is concave in time; so the lesser of both ends, less the deviations, bounds it over the whole segment: bodies that move
/// together stay apart. Boxes are separated along the axes of one body, which turn with it: there its own points stay where they are, and
/// those of the other body stay near a chord of their own (SeenMotion). Nothing is ever proven apart where a pose or a step is not
/// finite.
#pragma once

#include <array>

#include "core/geometry/body_hierarchy.hpp"
#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::core::ccd {

/// Rounding of sums of some thirty products, relative to the sizes that enter them.
inline constexpr double search_rounding = 1e-14;

/// A body at the two ends of its segment.
struct SweptBody {
    const model::Body* body = nullptr;
    std::array<kinematics::Pose, 2> ends;
    double loss = 0;      ///< per metre of radius: B0, and the rounding of placed points (chord_deviation.hpp); infinite if not finite
    double turn = 0;      ///< |w|
    double rounding = 0;  ///< per metre of radius, of points placed at an end
    double stretch = 0;   ///< bound of |R^T R - 1|, the same all along the segment: zero but for rounding
    /// How far its points within `radius` may leave the chords of their computed places in between, besides the rounding of positions, [m].
    double deviation(double radius) const { return loss * radius; }
};

SweptBody swept_body(const model::Body& body, const kinematics::PathSegment& segment);

/// A body in the frame of another, whose axes are those of the other body and turn with it: at both ends its points are at
/// rotation X + offset, and in between nowhere farther than loss(|X|) from the box of these two places.
struct SeenMotion {
    std::array<Matrix3, 2> rotation;
    std::array<Vector3, 2> offset;  ///< [m]
    double loss_constant = 0, loss_rate = 0;
    double loss(double radius) const { return loss_constant + loss_rate * radius; }
};

struct SweptPair {
    const SweptBody *a = nullptr, *b = nullptr;
    double margin = 0;                 ///< nodes and primitives farther apart than this, besides deviations, do not matter [m]
    double reach = 0, world_size = 0;  ///< of positions [m], for rounding: relative to one another, with radii; in the world
    SeenMotion a_seen_from_b, b_seen_from_a;
    const geometry::FlatFeatures *plane_a = nullptr, *plane_b = nullptr;  ///< whose plane edges are left out (plane_edges.hpp)
    double deviation(double radius_a, double radius_b) const { return a->deviation(radius_a) + b->deviation(radius_b); }
};

/// Contract: `a` and `b` outlive the result.
///
/// SeenMotion::loss is such that boxes which are apart by more than the margin along an axis of the frame, one in its own body's frame
/// and one widened by the loss, belong to points that are apart by more than the margin all along the segments
/// (docs/method/collision.md#broad-phase).
SweptPair swept_pair(const SweptBody& a, const SweptBody& b, double margin);

}  // namespace fettle::core::ccd
