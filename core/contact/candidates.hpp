// SPDX-License-Identifier: MIT
/// Broad phase: every pair of primitives of different bodies that could come within the activation distance while the bodies move along
/// given path segments, and no more than an allowance away from them. Found by descending the bodies' hierarchies two at a time.
///
/// Boxes and primitives are separated along a fixed direction n at both ends of the segments. Each vertex stays within its chord deviation
/// (method.md section 7, B0 = |w|^2 |X| / 8) of a straight line, and the separation min_a n.a - max_b n.b of points that move straight is
/// concave in time; so the lesser of both ends, less the deviations, bounds it over the whole segment: bodies that move together stay
/// apart.
#pragma once

#include <array>
#include <vector>

#include "fettle/core/kinematics/path.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::contact {

/// How far a body may move: a point X by at most translation + rotation |X|.
struct MotionAllowance {
    double translation = 0;  ///< [m]
    double rotation = 0;     ///< [rad]
};

/// Two primitives by index into their bodies' meshes, and a lower bound of their distance along the segments: while the bodies have left
/// those by less, the pair needs no second look.
struct PrimitivePair {
    int a = 0, b = 0;
    double distance = 0;  ///< [m]
};

/// Primitives of two bodies, a < b. Each list is sorted by distance.
struct BodyPairCandidates {
    int a = 0, b = 0;
    std::vector<PrimitivePair> vertex_triangle;  ///< vertex of a, face of b (BodyHierarchy::faces: triangles first)
    std::vector<PrimitivePair> triangle_vertex;  ///< face of a, vertex of b
    std::vector<PrimitivePair> edge_edge;        ///< edge of a, edge of b
    bool empty() const { return vertex_triangle.empty() && triangle_vertex.empty() && edge_edge.empty(); }
};

struct Candidates {
    std::vector<BodyPairCandidates> pairs;    ///< sorted by (a, b)
    std::vector<kinematics::Pose> poses;      ///< a configuration on the segments that they were found along (at first, the start).
                                              ///< Whoever moves along the segments may move it too: allowances count from here
    std::vector<MotionAllowance> allowances;  ///< per body
};

/// All pairs whose distance, somewhere along the segments, is at most dmin + dhat + (allowances of both primitives).
Candidates find_candidates(const model::Model& model, const std::vector<kinematics::PathSegment>& segments,
                           const std::vector<MotionAllowance>& allowances);

/// The same at a configuration.
Candidates find_candidates(const model::Model& model, const std::vector<kinematics::Pose>& poses,
                           const std::vector<MotionAllowance>& allowances);

/// Upper bounds of how far any point of each body is from candidates.poses, [m].
std::vector<double> displacements(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::Pose>& poses);

/// The same over the whole of each segment.
std::vector<double> displacements(const model::Model& model, const Candidates& candidates,
                                  const std::vector<kinematics::PathSegment>& segments);

/// Largest fraction of the segments along which the candidates are complete (up to the activation distance): while each body stays within
/// its allowance of candidates.poses.
double covered_fraction(const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments);

}  // namespace fettle::core::contact
