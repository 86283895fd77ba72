// SPDX-License-Identifier: MIT
#include "core/contact/near_search.hpp"

#include <algorithm>
#include <limits>
#include <new>

#include "core/base/parallel.hpp"
#include "core/ccd/plane_edges.hpp"
#include "core/geometry/body_hierarchy.hpp"

namespace fettle::core::contact {
namespace {

using ccd::flat_features_of;
using kinematics::Pose;

// Surely at least so far apart. Not so what is not finite: that stays a contact, of infinite potential.
bool is_beyond(double distance_squared, double limit_squared) {
    return distance_squared >= limit_squared && distance_squared <= std::numeric_limits<double>::max();
}

// The pairs of one pair of bodies that are closer than the activation distance.
class NearSearch {
public:
    NearSearch(const model::Model& model, const ccd::BodyPairCandidates& list, const std::vector<Pose>& poses,
               const WorldVertices& vertices)
        : model_(model),
          list_(list),
          a_{model.bodies[list.a], vertices.of(list.a)},
          b_{model.bodies[list.b], vertices.of(list.b)},
          activation_(model.dmin + model.dhat) {
        reach_ = activation_ + ccd::motion_since(model, list, poses);
    }

    /// @return the least squared distance
    double find(NearPairs& near) {
        near.clear();
        for (const auto& [v, t, distance] : list_.vertex_triangle) {
            if (distance > reach_) break;
            add_vertex(a_, v, b_, t, near.on_second);
        }
        for (const auto& [t, v, distance] : list_.triangle_vertex) {
            if (distance > reach_) break;
            add_vertex(b_, v, a_, t, near.on_first);
        }
        add_edges(near.edges);
        return least_;
    }

private:
    struct Side {
        const model::Body& body;
        WorldVertices::OfBody vertex;
    };

    // Most candidates within reach are near: they are worked out in the place where they stay, as copying takes as long as the arithmetic.
    static ContactPair& begin(geometry::PairType type, std::vector<ContactPair>& out) {
        ContactPair& pair = out.emplace_back();
        pair.type = type;
        return pair;
    }

    // Works out the last pair, whose vertices are there. Is it near? Else it is removed.
    bool work_out(std::vector<ContactPair>& out) {
        ContactPair& pair = out.back();
        new (&pair.closest) geometry::ClosestPoints(closest_points(pair.type, pair.x));
        const double distance_squared = pair.closest.distance_squared;
        if (is_beyond(distance_squared, activation_ * activation_)) {
            out.pop_back();
            return false;
        }
        least_ = least_of(least_, distance_squared);
        return true;
    }

    void add_vertex(const Side& point, int v, const Side& face, int t, std::vector<ContactPair>& out) {
        const geometry::Triangle& corners = face.body.hierarchy->faces()[t];
        ContactPair& pair = begin(geometry::PairType::point_triangle, out);
        pair.x[0] = point.vertex(v);
        for (std::size_t k = 0; k < 3; ++k) pair.x[k + 1] = face.vertex(corners[k]);
        if (!work_out(out)) return;
        pair.face = t;
        pair.vertex = {v, corners[0], corners[1], corners[2]};
        if (model_.area_weighted) pair.weight = 0.5 * point.body.vertex_area[v];
    }

    // Edges within plane faces are no contacts of their own: an edge that nears a plane face nears it with an end, or nears its border.
    void add_edges(std::vector<ContactPair>& out) {
        const model::Body &a = a_.body, &b = b_.body;
        const geometry::FlatFeatures *flat_a = flat_features_of(model_, a), *flat_b = flat_features_of(model_, b);
        for (const auto& [ea, eb, distance] : list_.edge_edge) {
            if (distance > reach_) break;
            if ((flat_a && flat_a->is_flat_edge(ea)) || (flat_b && flat_b->is_flat_edge(eb))) continue;
            const geometry::Edge &va = a.mesh.edges[ea], &vb = b.mesh.edges[eb];
            ContactPair& pair = begin(geometry::PairType::edge_edge, out);
            for (std::size_t k = 0; k < 2; ++k) {
                pair.x[k] = a_.vertex(va[k]);
                pair.x[k + 2] = b_.vertex(vb[k]);
            }
            if (!work_out(out)) continue;
            pair.vertex = {va[0], va[1], vb[0], vb[1]};
            pair.mollifier_eps = mollifier_scale * a.edge_length_squared[ea] * b.edge_length_squared[eb];
            if (model_.area_weighted) pair.weight = 0.5 * std::min(a.edge_area[ea], b.edge_area[eb]);
        }
    }

    const model::Model& model_;
    const ccd::BodyPairCandidates& list_;
    Side a_, b_;
    double activation_, reach_ = 0;
    double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

WorldVertices::WorldVertices(const model::Model& model, const ccd::Candidates& candidates, const std::vector<Pose>& poses)
    : model_(model), poses_(poses), begin_(model.bodies.size(), -1) {
    constexpr Eigen::Index small = 64;
    constexpr int bodies_a_piece = 64;
    int count = 0;
    std::vector<int> placed;
    for (const ccd::BodyPairCandidates& list : candidates.pairs) {
        if (list.empty()) continue;
        for (const int body : {list.a, list.b}) {
            int& begin = begin_[body];
            const Eigen::Index vertices = model_.bodies[body].mesh.vertices.cols();
            if (begin >= 0 || vertices > small) continue;
            begin = count;
            count += static_cast<int>(vertices);
            placed.push_back(body);
        }
    }
    vertices_.resize(count);
    base::parallel_for(count_of(placed), bodies_a_piece, [&](int k) {
        const auto body = static_cast<std::size_t>(placed[k]);
        const auto& vertices = model_.bodies[body].mesh.vertices;
        Vector3* at = vertices_.data() + begin_[body];
        for (Eigen::Index v = 0; v < vertices.cols(); ++v) at[v] = world_position(poses_[body], vertices.col(v));
    });
}

double find_near(const NearAt& at, NearPairs& near) { return NearSearch(at.model, at.list, at.poses, at.vertices).find(near); }

CountedSides counted_sides(const model::Model& model, const ccd::BodyPairCandidates& list, const std::vector<Pose>& poses) {
    const auto side = [&](int body) { return ContactSide{model.bodies[body], poses[body], flat_features_of(model, model.bodies[body])}; };
    const bool by_element = model.contact_damping_time > 0;  // it feels more than the distance at one time
    return {side(list.a), side(list.b), model.dmin + model.dhat, by_element};
}

}  // namespace fettle::core::contact
