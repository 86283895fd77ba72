// SPDX-License-Identifier: MIT
#include "core/contact/contact_set.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/contact/near_search.hpp"
#include "core/contact/round_contacts.hpp"
#include "core/linear/matrices.hpp"

namespace fettle::core::contact {
namespace {

using kinematics::Pose;

// Contacts of a run of pairs of bodies.
struct Found {
    ContactSet set;
    double least = std::numeric_limits<double>::infinity();  // squared distance
};

// Adds those of one pair of bodies; vertices on the higher body come as a list of their own.
void add_contacts(const NearAt& at, CountingPlan* plan, Found& found) {
    const ccd::BodyPairCandidates& list = at.list;
    if (list.empty()) return;
    static thread_local NearPairs near;
    const double least = find_near(at, near);
    BodyPairContacts forward{list.a, list.b, {}}, backward{list.b, list.a, {}};
    const double gap = find_round_contacts(at, near, forward.contacts, backward.contacts);
    count_contacts(counted_sides(at.model, list, at.poses), near, forward.contacts, backward.contacts, {nullptr, nullptr, plan});
    found.least = least_of(found.least, least_of(least, gap * std::max(gap, 0.0)));
    if (std::isfinite(least)) found.set.distances.push_back({list.a, list.b, std::sqrt(least)});
    for (BodyPairContacts* contacts : {&forward, &backward}) {
        found.set.count += count_of(contacts->contacts);
        if (!contacts->contacts.empty()) found.set.pairs.push_back(std::move(*contacts));
    }
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

// A plan for each pair of the candidates: those that are known, and empty ones.
void take_over(const ccd::Candidates& candidates, ContactPlans& plans) {
    const auto is_of = [](const ContactPlans::OfPair& of, const ccd::BodyPairCandidates& pair) { return of.a == pair.a && of.b == pair.b; };
    if (std::equal(plans.pairs.begin(), plans.pairs.end(), candidates.pairs.begin(), candidates.pairs.end(), is_of)) return;
    std::vector<ContactPlans::OfPair> from = std::exchange(plans.pairs, {});
    plans.pairs.reserve(candidates.pairs.size());
    auto old = from.begin();
    for (const ccd::BodyPairCandidates& pair : candidates.pairs) {
        while (old != from.end() && std::pair(old->a, old->b) < std::pair(pair.a, pair.b)) ++old;
        if (old != from.end() && is_of(*old, pair))
            plans.pairs.push_back(std::move(*old++));
        else
            plans.pairs.push_back({pair.a, pair.b, {}});
    }
}

// The potential of the contacts of one ordered pair of bodies.
double potential_of(const BodyPairContacts& list, const BarrierParameters& parameters) {
    double sum = 0;
    for (const ContactPair& pair : list.contacts) {
        const double gap = gap_of(pair);
        if (!(gap > parameters.dmin) || !std::isfinite(gap)) return std::numeric_limits<double>::infinity();
        sum += pair_potential(pair, parameters);
    }
    return sum;
}

}  // namespace

ContactSet find_contacts(const model::Model& model, const ccd::Candidates& candidates, const std::vector<Pose>& poses,
                         ContactPlans* plans) {
    const int count = count_of(candidates.pairs);
    if (plans != nullptr) take_over(candidates, *plans);
    const WorldVertices vertices(model, candidates, poses);
    const auto find = [&](int begin, int end) {
        Found found;
        for (int k = begin; k < end; ++k)
            add_contacts({model, candidates.pairs[k], poses, vertices}, plans == nullptr ? nullptr : &plans->pairs[k].plan, found);
        return found;
    };
    const auto join = [](Found&& so_far, Found&& found) {
        append(so_far.set.pairs, found.set.pairs);
        append(so_far.set.distances, found.set.distances);
        so_far.set.count += found.set.count;
        so_far.least = least_of(so_far.least, found.least);
        return std::move(so_far);
    };
    Found all = base::ordered_reduce(count, candidates.pairs_at_once(), Found{}, find, join);
    all.set.minimum_distance = std::sqrt(all.least);
    return std::move(all.set);
}

double barrier_potential(const ContactSet& set, const BarrierParameters& parameters) {
    std::vector<double> values(set.pairs.size());
    base::parallel_for(count_of(set.pairs), geometry::pairs_at_once(set.pairs.size(), static_cast<std::size_t>(set.count)),
                       [&](int k) { values[k] = potential_of(set.pairs[k], parameters); });
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

void add_barrier_derivatives(const ContactSet& set, const std::vector<Pose>& poses, const BarrierParameters& parameters, HessianKind kind,
                             std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian) {
    const auto make = [&](int k, BodyPairSum& sum) {
        const BodyPairContacts& list = set.pairs[k];
        for (const ContactPair& pair : list.contacts)
            add_pair_derivatives(pair, parameters, kind, poses[list.first].position, poses[list.second].position, sum);
    };
    add_pair_sums(bodies_of(set.pairs), static_cast<std::size_t>(set.count), make, kind, gradients, hessian);
}

void add_pair_sums(const std::vector<std::array<int, 2>>& bodies, std::size_t contacts,
                   const std::function<void(int k, BodyPairSum& sum)>& make, HessianKind kind,
                   std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian) {
    struct Made {
        kinematics::PoseGradient first, second;
        Matrix6 of_first, of_second, cross;  // cross: of the lower body's rows
    };
    const auto made = std::make_unique_for_overwrite<Made[]>(bodies.size());
    base::parallel_for(count_of(bodies), geometry::pairs_at_once(bodies.size(), contacts), [&](int k) {
        BodyPairSum sum;
        make(k, sum);
        made[k].first = sum.first;
        made[k].second = sum.second;
        if (kind == HessianKind::none) return;
        const Matrix12 full = in_both_bodies(sum.hessian);
        made[k].of_first = full.topLeftCorner<6, 6>();
        made[k].of_second = full.bottomRightCorner<6, 6>();
        made[k].cross = bodies[k][0] < bodies[k][1] ? full.topRightCorner<6, 6>() : full.bottomLeftCorner<6, 6>();
    });
    std::vector<std::array<int, 2>> pairs;
    if (kind != HessianKind::none)
        for (const auto& [first, second] : bodies) pairs.push_back({std::min(first, second), std::max(first, second)});
    const std::vector<int> places = linear::place_blocks(pairs, hessian);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        const auto [first, second] = bodies[k];
        gradients[first].force += made[k].first.force;
        gradients[first].arm += made[k].first.arm;
        gradients[second].force += made[k].second.force;
        gradients[second].arm += made[k].second.arm;
        if (kind == HessianKind::none) continue;
        hessian.diagonal[first] += made[k].of_first;
        hessian.diagonal[second] += made[k].of_second;
        hessian.off_diagonal[places[k]].block += made[k].cross;
    }
}

}  // namespace fettle::core::contact
