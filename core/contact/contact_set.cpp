// SPDX-License-Identifier: MIT
#include "fettle/core/contact/contact_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/geometry/body_hierarchy.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

Vector3 vertex(const model::Body& body, const Pose& pose, int v) { return world_position(pose, body.mesh.vertices.col(v)); }

// Calls visit(first, second, pair) with vertices filled, for every candidate in order that may be closer than the activation distance.
template <class Visit>
void for_each_pair(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses, double activation,
                   const Visit& visit) {
    if (list.empty()) return;
    const double reach = activation + motion_since(model, list, poses);
    const model::Body &a = model.bodies[list.a], &b = model.bodies[list.b];
    const Pose &pa = poses[list.a], &pb = poses[list.b];
    ContactPair pair;
    const auto point_triangle = [&](const model::Body& vb, const Pose& vp, int v, const model::Body& tb, const Pose& tp, int t) {
        const geometry::Triangle& corners = tb.hierarchy->faces()[t];
        pair.weight = model.area_weighted ? 0.5 * vb.vertex_area[v] : 1;
        pair.vertex = {v, corners[0], corners[1], corners[2]};
        pair.x[0] = vertex(vb, vp, v);
        for (int k = 0; k < 3; ++k) pair.x[k + 1] = vertex(tb, tp, corners[k]);
    };
    for (const auto& [v, t, distance] : list.vertex_triangle) {
        if (distance > reach) break;
        point_triangle(a, pa, v, b, pb, t);
        visit(list.a, list.b, pair);
    }
    for (const auto& [t, v, distance] : list.triangle_vertex) {
        if (distance > reach) break;
        point_triangle(b, pb, v, a, pa, t);
        visit(list.b, list.a, pair);
    }
    pair.type = PairType::edge_edge;
    for (const auto& [ea, eb, distance] : list.edge_edge) {
        if (distance > reach) break;
        const geometry::Edge &va = a.mesh.edges[ea], &vb = b.mesh.edges[eb];
        pair.edge = {ea, eb};
        pair.vertex = {va[0], va[1], vb[0], vb[1]};
        pair.x = {vertex(a, pa, va[0]), vertex(a, pa, va[1]), vertex(b, pb, vb[0]), vertex(b, pb, vb[1])};
        pair.weight = model.area_weighted ? 0.5 * std::min(a.edge_area[ea], b.edge_area[eb]) : 1;
        pair.mollifier_eps = mollifier_scale * a.edge_length_squared[ea] * b.edge_length_squared[eb];
        visit(list.a, list.b, pair);
    }
}

// Surely at least so far apart. Not so what is not finite: that stays a contact, of infinite potential.
bool is_beyond(double distance_squared, double limit_squared) {
    return distance_squared >= limit_squared && distance_squared <= std::numeric_limits<double>::max();
}

// The lesser; what is not a number wins.
double least_of(double a, double b) { return a <= b || std::isnan(a) ? a : b; }

// Where a pair stands in the order of its bodies' primitives.
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

ListContacts contacts_of(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses) {
    const double activation = model.dmin + model.dhat;
    ListContacts out{{list.a, list.b, {}}, {list.b, list.a, {}}};
    for_each_pair(model, list, poses, activation, [&](int first, int, ContactPair& pair) {
        pair.closest = closest_points(pair.type, pair.x);
        if (is_beyond(pair.closest.distance_squared, activation * activation)) return;
        out.least = least_of(out.least, pair.closest.distance_squared);
        (first == list.a ? out.forward : out.backward).contacts.push_back(pair);
    });
    for (BodyPairContacts* contacts : {&out.forward, &out.backward})
        std::sort(contacts->contacts.begin(), contacts->contacts.end(),
                  [](const ContactPair& x, const ContactPair& y) { return key_of(x) < key_of(y); });
    return out;
}

double potential_of(const model::Model& model, const BodyPairCandidates& list, const std::vector<Pose>& poses,
                    const BarrierParameters& parameters) {
    const double activation_squared = parameters.activation * parameters.activation;
    const double dmin_squared = parameters.dmin * parameters.dmin;
    std::vector<std::tuple<int, Key, double>> terms;
    for_each_pair(model, list, poses, parameters.activation, [&](int first, int, ContactPair& pair) {
        pair.closest = closest_points(pair.type, pair.x);
        if (is_beyond(pair.closest.distance_squared, activation_squared)) return;
        const bool apart = pair.closest.distance_squared > dmin_squared && std::isfinite(pair.closest.distance_squared);
        const double value = apart ? pair_potential(pair, parameters) : std::numeric_limits<double>::infinity();
        terms.emplace_back(first, key_of(pair), value);
    });
    std::sort(terms.begin(), terms.end());
    double sum = 0;
    for (const auto& [first, key, value] : terms) sum += value;
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

double barrier_potential(const model::Model& model, const Candidates& candidates, const std::vector<Pose>& poses,
                         const BarrierParameters& parameters) {
    const int count = static_cast<int>(candidates.pairs.size());
    std::vector<double> values(candidates.pairs.size());
    base::parallel_for(count, pairs_a_piece, [&](int k) {
        const BodyPairCandidates& list = candidates.pairs[k];
        values[k] = potential_of(model, list, poses, parameters);
    });
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
    const Matrix12 full = sum.hessian.selfadjointView<Eigen::Lower>();
    hessian.diagonal[first] += full.topLeftCorner<6, 6>();
    hessian.diagonal[second] += full.bottomRightCorner<6, 6>();
    kinematics::OffDiagonalBlock& block = off_diagonal(hessian, std::min(first, second), std::max(first, second));
    if (first < second)
        block.block += full.topRightCorner<6, 6>();
    else
        block.block += full.bottomLeftCorner<6, 6>();
}

}  // namespace fettle::core::contact
