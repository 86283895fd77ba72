// SPDX-License-Identifier: MIT
/// The pairs of primitives of two bodies that are near, with the weights that the barrier gives each: what contact_set.hpp and
/// contact_areas.hpp both count from.
#pragma once

#include <cmath>
#include <vector>

#include "fettle/core/contact/candidates.hpp"
#include "fettle/core/contact/counted_contacts.hpp"

namespace fettle::core::contact {

/// Vertices of bodies in space. Of small meshes all are placed beforehand: contacts ask for each several times.
class WorldVertices {
public:
    WorldVertices(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::Pose>& poses);

    Vector3 operator()(int body, int v) const {
        const int begin = begin_[static_cast<std::size_t>(body)];
        if (begin >= 0) return vertices_[static_cast<std::size_t>(begin + v)];
        return world_position(poses_[static_cast<std::size_t>(body)], model_.bodies[static_cast<std::size_t>(body)].mesh.vertices.col(v));
    }

private:
    const model::Model& model_;
    const std::vector<kinematics::Pose>& poses_;
    std::vector<int> begin_;  // [body] into vertices_; -1: not there
    std::vector<Vector3> vertices_;
};

/// The lesser; what is not a number wins.
inline double least_of(double a, double b) { return a <= b || std::isnan(a) ? a : b; }

/// Where two bodies are.
struct NearAt {
    const model::Model& model;
    const BodyPairCandidates& list;
    const std::vector<kinematics::Pose>& poses;
    const WorldVertices& vertices;
};

/// The candidates of one pair of bodies that are closer than the activation distance; what `near` held is lost.
/// @return the least squared distance
double find_near(const NearAt& at, NearPairs& near);

/// What count_contacts wants to know of them.
CountedSides counted_sides(const model::Model& model, const BodyPairCandidates& list, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::contact
