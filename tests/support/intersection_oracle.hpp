// SPDX-License-Identifier: MIT
/// Do bodies intersect, at instants of a trajectory and between them? Decided by CGAL's exact predicates, which share nothing with core:
/// the independent judge of "no intersection" in whole simulations. Culling is conservative and of its own kind too (element_tree.hpp).
///
/// At instants: triangle and triangle, edge of no triangle and triangle. Between instants: passages of loose edges through loose edges and
/// of loose points through triangles (passage_oracle.hpp), which no instant shows. Positions are rounded to double before they are judged.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/base/types.hpp"
#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "tests/support/element_tree.hpp"

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
    Element element_a, element_b;
};
std::string to_string(const Intersection& intersection, const core::model::Model& model);

struct IntersectionReport {
    std::vector<Intersection> intersections;  ///< empty is what a test wants
    long instants = 0;                        ///< configurations looked at
    long element_pairs = 0;                   ///< judged exactly, after all culling
};

/// A model's bodies, ready for looking at many configurations.
class IntersectionOracle {
public:
    /// Keeps a reference to the model.
    explicit IntersectionOracle(const core::model::Model& model);

    /// Looks at one step, from its start to its end: at its nodes and at `instants_between` instants evenly between each two, all pairs of
    /// bodies that model::may_collide allows. Adds to `report`, which stops growing at `max_count` intersections.
    void look_at_step(const core::stepper::Trajectory& trajectory, int step, int instants_between, std::size_t max_count,
                      IntersectionReport& report) const;

    /// Looks at one configuration; `where` says which.
    void look_at(const std::vector<core::kinematics::Pose>& poses, const Intersection& where, std::size_t max_count,
                 IntersectionReport& report) const;

private:
    const core::model::Model& model_;
    std::vector<ElementTree> trees_;
};

/// Looks at every step, and at the end.
IntersectionReport find_intersections(const core::model::Model& model, const core::stepper::Trajectory& trajectory, int instants_between,
                                      std::size_t max_count = 10);

}  // namespace fettle::tests::support
