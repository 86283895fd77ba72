// SPDX-License-Identifier: MIT
/// Do triangles intersect? Decided by CGAL's exact predicates, which share nothing with core: the independent judge of
/// "no intersection" in whole simulations.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "fettle/core/base/types.hpp"
#include "fettle/core/model/model.hpp"
#include "fettle/core/stepper/trajectory.hpp"

namespace fettle::tests::support {

using SpaceTriangle = std::array<Vector3, 3>;

/// Pairs (index in a, index in b) that have a point in common, sorted. Contract: no triangle has zero area.
std::vector<std::pair<int, int>> intersecting_pairs(const std::vector<SpaceTriangle>& a, const std::vector<SpaceTriangle>& b);

/// The triangles of a mesh, moved.
std::vector<SpaceTriangle> triangles_in_space(const core::geometry::Mesh& mesh, const core::kinematics::Pose& pose);

struct Intersection {
    int step = 0, segment = 0;  ///< of the trajectory; step -1: the start of one without steps
    double s = 0;               ///< along that segment
    int body_a = 0, body_b = 0;
    int triangle_a = 0, triangle_b = 0;
};
std::string to_string(const Intersection& intersection, const core::model::Model& model);

struct IntersectionReport {
    std::vector<Intersection> intersections;  ///< empty is what a test wants
    long instants = 0;                        ///< configurations looked at
    long body_pairs = 0;                      ///< pairs of bodies whose boxes overlapped and whose triangles were compared
};

/// Looks at one step, from its start to its end: at its nodes and at `instants_between` instants evenly between each two. Adds to `report`,
/// which stops growing at `max_count` intersections.
void find_intersections_in_step(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int step,
                                int instants_between, std::size_t max_count, IntersectionReport& report);

/// Looks at every stored node and at `instants_between` instants evenly between each two, all pairs that model::may_collide
/// allows. The poses are those of the stored path (kinematics/path.hpp). At most `max_count` intersections are listed.
IntersectionReport find_intersections(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int instants_between,
                                      std::size_t max_count = 10);

}  // namespace fettle::tests::support
