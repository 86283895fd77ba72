// SPDX-License-Identifier: MIT
/// The pairs of primitives of two bodies that are near, with the weights that the barrier gives each: what contact_set.hpp and
/// contact_areas.hpp both count from.
#pragma once

#include <cmath>
#include <vector>

#include "core/ccd/candidates.hpp"
#include "core/contact/counted_contacts.hpp"

namespace fettle::core::contact {

/// Vertices of bodies in space. Those of small meshes are all placed beforehand: contacts ask for each several times.
class WorldVertices {
public:
    WorldVertices(const model::Model& model, const ccd::Candidates& candidates, const std::vector<kinematics::Pose>& poses);

    /// Those of one body.
    class OfBody {
    public:
        Vector3 operator()(int v) const { return placed_ != nullptr ? placed_[v] : world_position(pose_, mesh_.vertices.col(v)); }

    private:
        friend class WorldVertices;
        OfBody(const Vector3* placed, const kinematics::Pose& pose, const geometry::Mesh& mesh)
            : placed_(placed), pose_(pose), mesh_(mesh) {}
        const Vector3* placed_;  // null: not there
        const kinematics::Pose& pose_;
        const geometry::Mesh& mesh_;
    };
    OfBody of(int body) const {
        const auto i = static_cast<std::size_t>(body);
        return {begin_[i] < 0 ? nullptr : vertices_.data() + begin_[i], poses_[i], model_.bodies[i].mesh};
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
    const ccd::BodyPairCandidates& list;
    const std::vector<kinematics::Pose>& poses;
    const WorldVertices& vertices;
};

/// The candidates of one pair of bodies that are closer than the activation distance; what `near` held is lost.
/// @return the least squared distance
double find_near(const NearAt& at, NearPairs& near);

/// What count_contacts wants to know of them.
CountedSides counted_sides(const model::Model& model, const ccd::BodyPairCandidates& list, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::contact
