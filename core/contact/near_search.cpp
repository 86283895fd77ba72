// SPDX-License-Identifier: MIT
#include "fettle/core/contact/near_search.hpp"

#include <algorithm>
#include <limits>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

bool is_finite(const Pose& pose) { return pose.rotation.allFinite() && pose.position.allFinite(); }

double gap_squared(const Vector3& low_a, const Vector3& high_a, const Vector3& low_b, const Vector3& high_b) {
    return (low_b - high_a).cwiseMax(low_a - high_b).cwiseMax(0.0).squaredNorm();
}

// Squared distance of the two primitives' boxes. Of finite vertices.
template <PairType type>
double box_distance_squared(const PairVertices& x) {
    if constexpr (type == PairType::point_triangle)
        return gap_squared(x[0], x[0], x[1].cwiseMin(x[2]).cwiseMin(x[3]), x[1].cwiseMax(x[2]).cwiseMax(x[3]));
    else
        return gap_squared(x[0].cwiseMin(x[1]), x[0].cwiseMax(x[1]), x[2].cwiseMin(x[3]), x[2].cwiseMax(x[3]));
}

// Null where nothing of the body is flat enough to be left out beside the activation distance.
const geometry::FlatFeatures* flat_features_of(const model::Model& model, const model::Body& body) {
    constexpr double negligible = 1e-2;  // of dhat: what is left out is nearer than what stays by no more
    return body.flat && body.flat->any() && body.flat->height <= negligible * model.dhat ? body.flat.get() : nullptr;
}

// Surely at least so far apart. Not so what is not finite: that stays a contact, of infinite potential.
bool is_beyond(double distance_squared, double limit_squared) {
    return distance_squared >= limit_squared && distance_squared <= std::numeric_limits<double>::max();
}

// The pairs of one pair of bodies that are closer than the activation distance.
class NearSearch {
public:
    NearSearch(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses, const WorldVertices& vertices)
        : model_(model), list_(list), vertices_(vertices), activation_(model.dmin + model.dhat) {
        reach_ = activation_ + motion_since(model, list, poses);
        finite_ = is_finite(poses[list.a]) && is_finite(poses[list.b]);
    }

    /// @return the least squared distance
    double find(NearPairs& near) {
        near.clear();
        for (const auto& [v, t, distance] : list_.vertex_triangle) {
            if (distance > reach_) break;
            add_vertex(list_.a, v, list_.b, t, near.on_second);
        }
        for (const auto& [t, v, distance] : list_.triangle_vertex) {
            if (distance > reach_) break;
            add_vertex(list_.b, v, list_.a, t, near.on_first);
        }
        add_edges(near.edges);
        return least_;
    }

private:
    // Is what is at `x` near? Then it is appended, and the rest is the caller's.
    template <PairType type>
    ContactPair* add(const PairVertices& x, std::vector<ContactPair>& out) {
        constexpr double margin = 1 + 1e-9;  // of the boxes' squared distance, for rounding
        if (finite_ && box_distance_squared<type>(x) > margin * activation_ * activation_) return nullptr;
        const geometry::ClosestPoints closest = closest_points(type, x);
        if (is_beyond(closest.distance_squared, activation_ * activation_)) return nullptr;
        least_ = least_of(least_, closest.distance_squared);
        ContactPair& pair = out.emplace_back();
        pair.type = type;
        pair.x = x;
        pair.closest = closest;
        return &pair;
    }

    void add_vertex(int vertex_body, int v, int face_body, int t, std::vector<ContactPair>& out) {
        const model::Body& vertex_of = model_.bodies[vertex_body];
        const geometry::Triangle& corners = model_.bodies[face_body].hierarchy->faces()[t];
        ContactPair* pair = add<PairType::point_triangle>({vertices_(vertex_body, v), vertices_(face_body, corners[0]),
                                                           vertices_(face_body, corners[1]), vertices_(face_body, corners[2])},
                                                          out);
        if (pair == nullptr) return;
        pair->face = t;
        pair->vertex = {v, corners[0], corners[1], corners[2]};
        if (model_.area_weighted) pair->weight = 0.5 * vertex_of.vertex_area[v];
    }

    // Edges within plane faces are no contacts of their own: an edge that nears a plane face nears it with an end, or nears its border.
    void add_edges(std::vector<ContactPair>& out) {
        const model::Body &a = model_.bodies[list_.a], &b = model_.bodies[list_.b];
        const geometry::FlatFeatures *flat_a = flat_features_of(model_, a), *flat_b = flat_features_of(model_, b);
        for (const auto& [ea, eb, distance] : list_.edge_edge) {
            if (distance > reach_) break;
            if ((flat_a && flat_a->is_flat_edge(ea)) || (flat_b && flat_b->is_flat_edge(eb))) continue;
            const geometry::Edge &va = a.mesh.edges[ea], &vb = b.mesh.edges[eb];
            ContactPair* pair = add<PairType::edge_edge>(
                {vertices_(list_.a, va[0]), vertices_(list_.a, va[1]), vertices_(list_.b, vb[0]), vertices_(list_.b, vb[1])}, out);
            if (pair == nullptr) continue;
            pair->vertex = {va[0], va[1], vb[0], vb[1]};
            pair->mollifier_eps = mollifier_scale * a.edge_length_squared[ea] * b.edge_length_squared[eb];
            if (model_.area_weighted) pair->weight = 0.5 * std::min(a.edge_area[ea], b.edge_area[eb]);
        }
    }

    const model::Model& model_;
    const BodyPairCandidates& list_;
    const WorldVertices& vertices_;
    double activation_, reach_ = 0;
    bool finite_ = false;
    double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

WorldVertices::WorldVertices(const model::Model& model, const Candidates& candidates, const std::vector<Pose>& poses)
    : model_(model), poses_(poses), begin_(model.bodies.size(), -1) {
    constexpr Eigen::Index small = 64;
    constexpr int bodies_a_piece = 64;
    int count = 0;
    std::vector<int> placed;
    for (const BodyPairCandidates& list : candidates.pairs) {
        if (list.empty()) continue;
        for (const int body : {list.a, list.b}) {
            int& begin = begin_[static_cast<std::size_t>(body)];
            const Eigen::Index vertices = model_.bodies[static_cast<std::size_t>(body)].mesh.vertices.cols();
            if (begin >= 0 || vertices > small) continue;
            begin = count;
            count += static_cast<int>(vertices);
            placed.push_back(body);
        }
    }
    vertices_.resize(static_cast<std::size_t>(count));
    base::parallel_for(static_cast<int>(placed.size()), bodies_a_piece, [&](int k) {
        const auto body = static_cast<std::size_t>(placed[static_cast<std::size_t>(k)]);
        const auto& vertices = model_.bodies[body].mesh.vertices;
        Vector3* at = vertices_.data() + begin_[body];
        for (Eigen::Index v = 0; v < vertices.cols(); ++v) at[v] = world_position(poses_[body], vertices.col(v));
    });
}

double find_near(const NearAt& at, NearPairs& near) { return NearSearch(at.model, at.list, at.poses, at.vertices).find(near); }

CountedSides counted_sides(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses) {
    const auto side = [&](int body) { return ContactSide{model.bodies[body], poses[body], flat_features_of(model, model.bodies[body])}; };
    const bool by_element = model.contact_damping_time > 0;  // it feels more than the distance at one time
    return {side(list.a), side(list.b), model.dmin + model.dhat, by_element};
}

}  // namespace fettle::core::contact
