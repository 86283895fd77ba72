// SPDX-License-Identifier: MIT
/// Broad phase: every pair of primitives of different bodies that could come within the activation distance while the bodies move no
/// more than an allowance from where the candidates were found. Found by descending the bodies' hierarchies two at a time.
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

/// Two primitives by index into their bodies' meshes, and how far apart they were when found: what has moved less since needs no second look.
struct PrimitivePair {
    int a = 0, b = 0;
    double distance = 0;  ///< [m]
};

/// Primitives of two bodies, a < b. Each list is sorted by distance.
struct BodyPairCandidates {
    int a = 0, b = 0;
    std::vector<PrimitivePair> vertex_triangle;  ///< vertex of a, triangle of b
    std::vector<PrimitivePair> triangle_vertex;  ///< triangle of a, vertex of b
    std::vector<PrimitivePair> edge_edge;        ///< edge of a, edge of b
    bool empty() const { return vertex_triangle.empty() && triangle_vertex.empty() && edge_edge.empty(); }
};

struct Candidates {
    std::vector<BodyPairCandidates> pairs;            ///< sorted by (a, b)
    std::vector<kinematics::Pose> poses;              ///< where they were found
    std::vector<MotionAllowance> allowances;          ///< per body
};

/// All pairs whose distance is at most dmin + dhat + (allowances of both primitives).
Candidates find_candidates(const model::Model& model, const std::vector<kinematics::Pose>& poses,
                           const std::vector<MotionAllowance>& allowances);

/// Upper bounds of how far any point of each body is from where the candidates were found, [m].
std::vector<double> displacements(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::Pose>& poses);

/// The same over the whole of each segment.
std::vector<double> displacements(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments);

/// Largest fraction of the segments along which the candidates are complete (up to the activation distance). Each body may have moved since
/// they were found, and moves along its segment now: completeness holds while both together stay within its allowance.
double covered_fraction(const Candidates& candidates, const std::vector<kinematics::PathSegment>& segments);

}  // namespace fettle::core::contact
