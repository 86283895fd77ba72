// SPDX-License-Identifier: MIT
/// Broad phase: every pair of primitives of different bodies that could come within the activation distance while the bodies move along
/// given path segments, and no more than an allowance away from them.
///
/// Kept per pair of bodies: what was found stays valid while the two have moved little relative to one another, wherever they have gone
/// together and whatever the other bodies do. So a step searches anew only where something has happened. Where two bodies move steadily
/// a search looks a step ahead: the next one's candidates are among those that it found.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/ccd/side_pieces.hpp"
#include "core/geometry/overlapping_boxes.hpp"
#include "core/geometry/primitive_pair.hpp"
#include "core/kinematics/path.hpp"
#include "core/model/model.hpp"

namespace fettle::core::ccd {

/// What a search has found between two bodies, a < b, and where.
struct BodyPairCandidates : geometry::PrimitivePairs {
    int a = 0, b = 0;
    std::vector<SidePieces> sides;                 ///< of their round surfaces
    double allowance = 0;                          ///< how far from `along` the candidates are complete [m]
    bool fresh = false;                            ///< found by the last cover(), and not settled yet
    std::array<kinematics::PathSegment, 2> along;  ///< the way that was searched: the segments, or as far again where it is known ahead
    std::array<kinematics::Pose, 2> at;            ///< where on them the bodies went
};

/// Pairs of bodies, (a, b) in order, whose boxes overlap: known as long as the bodies stay in them.
struct NearBodies {
    std::vector<geometry::Box> boxes;  ///< [body], with room to move; empty: nothing is known
    std::vector<std::pair<int, int>> pairs;
};

struct Candidates {
    /// pairs_at_once() of them.
    int pairs_at_once() const;

    std::vector<BodyPairCandidates> pairs;  ///< sorted by (a, b). Pairs of bodies that are near but have no candidates are listed too
    NearBodies near;
    std::vector<std::pair<int, int>> bodies;  ///< of `pairs`
    std::vector<int> fresh;                   ///< those of `pairs` that are
    std::vector<BodyPairCandidates> spare;    ///< memory for the next list of pairs; empty
};

/// Least distance of two bodies, a < b, that have contacts, computed, not proven: of all their primitives, but for flat edges, which are
/// nearer by no more than the heights of the bodies' flat features (geometry/flat_features.hpp).
struct BodyDistance {
    int a = 0, b = 0;
    double distance = 0;  ///< [m], finite
};

/// Makes the candidates complete along the segments: lists every pair of primitives whose distance somewhere on them is at most
/// dmin + dhat, and what the two bodies' round surfaces reach beyond their meshes (geometry::RoundSurfaces::largest_height), but for pairs
/// of edges of which one is plane (plane_edges.hpp). Pairs of bodies that are covered already are left alone, the others are searched along
/// the segments. The bodies may then be anywhere on the segments, the same fraction for all; say with settle() where they went. A body
/// whose segment is not finite is near all others, with all primitives.
/// @param allowance  how much more the points of two bodies may approach one another than they do along the segments before the two need
///                   another search, [m]. Dear where large: this one must look that much farther.
void cover(const model::Model& model, const std::vector<kinematics::PathSegment>& segments, double allowance, Candidates& candidates);

/// The bodies went to `poses`, on the segments that were covered last. From here on each pair of bodies is covered while its
/// motion_since() or motion_over() is at most its allowance.
void settle(const std::vector<kinematics::Pose>& poses, Candidates& candidates);

/// Candidates at a configuration, settled there.
Candidates find_candidates(const model::Model& model, const std::vector<kinematics::Pose>& poses, double allowance);

/// Upper bound of how much nearer any point of one body can be to any of the other at these poses than it was along the segments that
/// were searched, [m]. Zero, by contract, for fresh pairs.
double motion_since(const model::Model& model, const BodyPairCandidates& pair, const std::vector<kinematics::Pose>& poses);

/// The same over the whole of each segment.
double motion_over(const model::Model& model, const BodyPairCandidates& pair, const std::vector<kinematics::PathSegment>& segments);
/// With the poses at the segments' starts known: pose_at(segment, 0) of a and of b.
double motion_over(const model::Model& model, const BodyPairCandidates& pair, const std::vector<kinematics::PathSegment>& segments,
                   const kinematics::Pose& start_a, const kinematics::Pose& start_b);

}  // namespace fettle::core::ccd
