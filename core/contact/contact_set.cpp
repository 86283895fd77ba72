// SPDX-License-Identifier: MIT
#include "fettle/core/contact/contact_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/contact/counted_contacts.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

bool is_finite(const Pose& pose) { return pose.rotation.allFinite() && pose.position.allFinite(); }

// Vertices of bodies in space. Of small meshes all are placed beforehand: contacts ask for each several times.
class WorldVertices {
public:
    WorldVertices(const model::Model& model, const Candidates& candidates, const std::vector<Pose>& poses)
        : model_(model), poses_(poses), begin_(model.bodies.size(), -1) {
        for (const BodyPairCandidates& list : candidates.pairs) {
            if (list.empty()) continue;
            place(list.a);
            place(list.b);
        }
    }

    Vector3 operator()(int body, int v) const {
        const int begin = begin_[static_cast<std::size_t>(body)];
        if (begin >= 0) return vertices_[static_cast<std::size_t>(begin + v)];
        return world_position(poses_[static_cast<std::size_t>(body)], model_.bodies[static_cast<std::size_t>(body)].mesh.vertices.col(v));
    }

private:
    void place(int body) {
        constexpr Eigen::Index small = 64;
        int& begin = begin_[static_cast<std::size_t>(body)];
        const auto& vertices = model_.bodies[static_cast<std::size_t>(body)].mesh.vertices;
        if (begin >= 0 || vertices.cols() > small) return;
        begin = static_cast<int>(vertices_.size());
        for (Eigen::Index v = 0; v < vertices.cols(); ++v)
            vertices_.push_back(world_position(poses_[static_cast<std::size_t>(body)], vertices.col(v)));
    }

    const model::Model& model_;
    const std::vector<Pose>& poses_;
    std::vector<int> begin_;  // [body] into vertices_; -1: not there
    std::vector<Vector3> vertices_;
};

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

// The lesser; what is not a number wins.
double least_of(double a, double b) { return a <= b || std::isnan(a) ? a : b; }

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

kinematics::OffDiagonalBlock& off_diagonal(kinematics::BlockHessian& hessian, int a, int b) {
    auto& blocks = hessian.off_diagonal;
    const auto at = std::lower_bound(blocks.begin(), blocks.end(), std::pair(a, b),
                                     [](const auto& block, const std::pair<int, int>& key) { return std::pair(block.a, block.b) < key; });
    if (at != blocks.end() && at->a == a && at->b == b) return *at;
    return *blocks.insert(at, {a, b, Matrix6::Zero()});
}

// Contacts of one pair of bodies; vertices on the higher body come as a list of their own.
struct ListContacts {
    BodyPairContacts forward, backward;
    double least = std::numeric_limits<double>::infinity();  // squared distance
};

ListContacts contacts_of(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses,
                         const WorldVertices& vertices) {
    ListContacts out{{list.a, list.b, {}}, {list.b, list.a, {}}};
    if (list.empty()) return out;
    static thread_local NearPairs near;
    out.least = NearSearch(model, list, poses, vertices).find(near);
    const auto side = [&](int body) { return ContactSide{model.bodies[body], poses[body], flat_features_of(model, model.bodies[body])}; };
    const bool by_element = model.contact_damping_time > 0;  // it feels more than the distance at one time
    count_contacts({side(list.a), side(list.b), model.dmin + model.dhat, by_element}, near, out.forward.contacts, out.backward.contacts);
    return out;
}

// Of the contacts of one ordered pair of bodies.
double potential_of(const BodyPairContacts& list, const BarrierParameters& parameters) {
    const double dmin_squared = parameters.dmin * parameters.dmin;
    double sum = 0;
    for (const ContactPair& pair : list.contacts) {
        const bool apart = pair.closest.distance_squared > dmin_squared && std::isfinite(pair.closest.distance_squared);
        if (!apart) return std::numeric_limits<double>::infinity();
        sum += pair_potential(pair, parameters);
    }
    return sum;
}

constexpr int pairs_a_piece = 16;  // pairs of bodies that a thread takes at a time

}  // namespace

ContactSet find_contacts(const model::Model& model, const Candidates& candidates, const std::vector<Pose>& poses) {
    const int count = static_cast<int>(candidates.pairs.size());
    std::vector<ListContacts> found(candidates.pairs.size());
    const WorldVertices vertices(model, candidates, poses);
    base::parallel_for(count, pairs_a_piece, [&](int k) { found[k] = contacts_of(model, candidates.pairs[k], poses, vertices); });
    ContactSet set;
    double least = std::numeric_limits<double>::infinity();
    for (ListContacts& list : found) {
        least = least_of(least, list.least);
        for (BodyPairContacts* contacts : {&list.forward, &list.backward}) {
            set.count += static_cast<int>(contacts->contacts.size());
            if (!contacts->contacts.empty()) set.pairs.push_back(std::move(*contacts));
        }
    }
    set.minimum_distance = std::sqrt(least);
    return set;
}

double barrier_potential(const ContactSet& set, const BarrierParameters& parameters) {
    std::vector<double> values(set.pairs.size());
    base::parallel_for(static_cast<int>(set.pairs.size()), pairs_a_piece,
                       [&](int k) { values[k] = potential_of(set.pairs[k], parameters); });
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

void add_barrier_derivatives(const ContactSet& set, const std::vector<Pose>& poses, const BarrierParameters& parameters, HessianKind kind,
                             std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian) {
    std::vector<BodyPairSum> sums(set.pairs.size());
    base::parallel_for(static_cast<int>(set.pairs.size()), pairs_a_piece, [&](int k) {
        const BodyPairContacts& list = set.pairs[k];
        for (const ContactPair& pair : list.contacts)
            add_pair_derivatives(pair, parameters, kind, poses[list.first].position, poses[list.second].position, sums[k]);
    });
    for (std::size_t k = 0; k < sums.size(); ++k) add_body_pair(set.pairs[k].first, set.pairs[k].second, sums[k], kind, gradients, hessian);
}

void add_body_pair(int first, int second, const BodyPairSum& sum, HessianKind kind, std::vector<kinematics::PoseGradient>& gradients,
                   kinematics::BlockHessian& hessian) {
    gradients[first].force += sum.first.force;
    gradients[first].arm += sum.first.arm;
    gradients[second].force += sum.second.force;
    gradients[second].arm += sum.second.arm;
    if (kind == HessianKind::none) return;
    const Matrix12 full = in_both_bodies(sum.hessian);
    hessian.diagonal[first] += full.topLeftCorner<6, 6>();
    hessian.diagonal[second] += full.bottomRightCorner<6, 6>();
    kinematics::OffDiagonalBlock& block = off_diagonal(hessian, std::min(first, second), std::max(first, second));
    if (first < second)
        block.block += full.topRightCorner<6, 6>();
    else
        block.block += full.bottomLeftCorner<6, 6>();
}

}  // namespace fettle::core::contact
