// SPDX-License-Identifier: MIT
#include "fettle/core/contact/contact_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/contact/face_contacts.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

Vector3 vertex(const model::Body& body, const Pose& pose, int v) { return world_position(pose, body.mesh.vertices.col(v)); }

bool is_finite(const Pose& pose) { return pose.rotation.allFinite() && pose.position.allFinite(); }

// Are the boxes of the two primitives so far apart? Of finite vertices.
bool are_boxes_beyond(const ContactPair& pair, double limit_squared) {
    const PairVertices& x = pair.x;
    const int n = first_count(pair.type);
    Vector3 low_a = x[0], high_a = x[0], low_b = x[3], high_b = x[3];
    for (int i = 1; i < 3; ++i) {
        Vector3 &low = i < n ? low_a : low_b, &high = i < n ? high_a : high_b;
        low = low.cwiseMin(x[i]);
        high = high.cwiseMax(x[i]);
    }
    return (low_b - high_a).cwiseMax(low_a - high_b).cwiseMax(0.0).squaredNorm() > limit_squared;
}

// Null where nothing of the body is flat enough to be left out beside the activation distance.
const geometry::FlatFeatures* flat_features_of(const model::Model& model, const model::Body& body) {
    constexpr double negligible = 1e-2;  // of dhat: what is left out is nearer than what stays by no more
    return body.flat && body.flat->any() && body.flat->height <= negligible * model.dhat ? body.flat.get() : nullptr;
}

// Calls visit(first, pair) with vertices filled, for every candidate that may be closer than the activation distance. Edges within plane
// faces are no contacts of their own: an edge that nears a plane face nears it with an end, or nears the face's border.
template <class Visit>
void for_each_pair(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses, double activation,
                   const Visit& visit) {
    if (list.empty()) return;
    constexpr double margin = 1 + 1e-9;  // of the boxes' squared distance, for rounding
    const double reach = activation + motion_since(model, list, poses);
    const model::Body &a = model.bodies[list.a], &b = model.bodies[list.b];
    const Pose &pa = poses[list.a], &pb = poses[list.b];
    const bool finite = is_finite(pa) && is_finite(pb);
    ContactPair pair;
    const auto visit_near = [&](int first) {
        if (!finite || !are_boxes_beyond(pair, margin * activation * activation)) visit(first, pair);
    };
    const auto point_triangle = [&](const model::Body& vb, const Pose& vp, int v, const model::Body& tb, const Pose& tp, int t) {
        const geometry::Triangle& corners = tb.hierarchy->faces()[t];
        pair.weight = model.area_weighted ? 0.5 * vb.vertex_area[v] : 1;
        pair.face = t;
        pair.vertex = {v, corners[0], corners[1], corners[2]};
        pair.x[0] = vertex(vb, vp, v);
        for (int k = 0; k < 3; ++k) pair.x[k + 1] = vertex(tb, tp, corners[k]);
    };
    for (const auto& [v, t, distance] : list.vertex_triangle) {
        if (distance > reach) break;
        point_triangle(a, pa, v, b, pb, t);
        visit_near(list.a);
    }
    for (const auto& [t, v, distance] : list.triangle_vertex) {
        if (distance > reach) break;
        point_triangle(b, pb, v, a, pa, t);
        visit_near(list.b);
    }
    pair.type = PairType::edge_edge;
    pair.face = -1;
    const geometry::FlatFeatures *flat_a = flat_features_of(model, a), *flat_b = flat_features_of(model, b);
    for (const auto& [ea, eb, distance] : list.edge_edge) {
        if (distance > reach) break;
        if ((flat_a && flat_a->is_flat_edge(ea)) || (flat_b && flat_b->is_flat_edge(eb))) continue;
        const geometry::Edge &va = a.mesh.edges[ea], &vb = b.mesh.edges[eb];
        pair.vertex = {va[0], va[1], vb[0], vb[1]};
        pair.x = {vertex(a, pa, va[0]), vertex(a, pa, va[1]), vertex(b, pb, vb[0]), vertex(b, pb, vb[1])};
        pair.weight = model.area_weighted ? 0.5 * std::min(a.edge_area[ea], b.edge_area[eb]) : 1;
        pair.mollifier_eps = mollifier_scale * a.edge_length_squared[ea] * b.edge_length_squared[eb];
        visit_near(list.a);
    }
}

// Surely at least so far apart. Not so what is not finite: that stays a contact, of infinite potential.
bool is_beyond(double distance_squared, double limit_squared) {
    return distance_squared >= limit_squared && distance_squared <= std::numeric_limits<double>::max();
}

// The lesser; what is not a number wins.
double least_of(double a, double b) { return a <= b || std::isnan(a) ? a : b; }

// Where a pair stands in the order of its bodies' primitives: pairs of vertices and faces first, by vertex.
using Key = std::array<int, 5>;
Key key_of(const ContactPair& pair) {
    return {pair.type == PairType::edge_edge ? 1 : 0, pair.vertex[0], pair.vertex[1], pair.vertex[2], pair.vertex[3]};
}

kinematics::OffDiagonalBlock& off_diagonal(kinematics::BlockHessian& hessian, int a, int b) {
    auto& blocks = hessian.off_diagonal;
    const auto at = std::lower_bound(blocks.begin(), blocks.end(), std::pair(a, b),
                                     [](const auto& block, const std::pair<int, int>& key) { return std::pair(block.a, block.b) < key; });
    if (at != blocks.end() && at->a == a && at->b == b) return *at;
    return *blocks.insert(at, {a, b, Matrix6::Zero()});
}

}  // namespace

namespace {

// Contacts of one pair of bodies; vertices on the higher body come as a list of their own.
struct ListContacts {
    BodyPairContacts forward, backward;
    double least = std::numeric_limits<double>::infinity();  // squared distance
};

// By way of their places: contacts are large.
void sort_by_key(std::vector<ContactPair>& contacts) {
    std::vector<std::pair<Key, int>> order;
    order.reserve(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k) order.emplace_back(key_of(contacts[k]), static_cast<int>(k));
    if (std::is_sorted(order.begin(), order.end())) return;
    std::sort(order.begin(), order.end());
    std::vector<ContactPair> sorted;
    sorted.reserve(contacts.size());
    for (const auto& [key, k] : order) sorted.push_back(contacts[static_cast<std::size_t>(k)]);
    contacts = std::move(sorted);
}

// Sorted: those of a vertex with faces become what counts of them.
void count_faces(const FaceSide& side, std::vector<ContactPair>& contacts) {
    std::vector<ContactPair> counted;
    counted.reserve(contacts.size());
    auto first = contacts.begin();
    while (first != contacts.end() && first->type == PairType::point_triangle) {
        auto last = first;
        while (last != contacts.end() && last->type == PairType::point_triangle && last->vertex[0] == first->vertex[0]) ++last;
        count_faces_once(side, {first, last}, counted);
        first = last;
    }
    counted.insert(counted.end(), first, contacts.end());
    contacts = std::move(counted);
}

ListContacts contacts_of(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses) {
    const double activation = model.dmin + model.dhat;
    ListContacts out{{list.a, list.b, {}}, {list.b, list.a, {}}};
    for_each_pair(model, list, poses, activation, [&](int first, ContactPair& pair) {
        pair.closest = closest_points(pair.type, pair.x);
        if (is_beyond(pair.closest.distance_squared, activation * activation)) return;
        out.least = least_of(out.least, pair.closest.distance_squared);
        (first == list.a ? out.forward : out.backward).contacts.push_back(pair);
    });
    for (BodyPairContacts* of : {&out.forward, &out.backward}) {
        sort_by_key(of->contacts);
        const model::Body& faces = model.bodies[of->second];
        count_faces({faces, poses[of->second], flat_features_of(model, faces), activation, model.contact_damping_time > 0}, of->contacts);
    }
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
    base::parallel_for(count, pairs_a_piece, [&](int k) {
        const BodyPairCandidates& list = candidates.pairs[k];
        found[k] = contacts_of(model, list, poses);
    });
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
    for (std::size_t k = 0; k < sums.size(); ++k) add_body_pair(set.pairs[k].first, set.pairs[k].second, sums[k], gradients, hessian);
}

void add_body_pair(int first, int second, const BodyPairSum& sum, std::vector<kinematics::PoseGradient>& gradients,
                   kinematics::BlockHessian& hessian) {
    gradients[first].force += sum.first.force;
    gradients[first].arm += sum.first.arm;
    gradients[second].force += sum.second.force;
    gradients[second].arm += sum.second.arm;
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
