// SPDX-License-Identifier: MIT
/// The pairs that are closer than the activation distance at one configuration, and the barrier potential summed over them.
/// Contacts are ordered by their primitives, so that sums do not depend on how and when the candidates were found.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/ccd/candidates.hpp"
#include "core/contact/barrier.hpp"
#include "core/contact/contact_pair.hpp"
#include "core/contact/counted_contacts.hpp"
#include "core/kinematics/tangent_system.hpp"

namespace fettle::core::contact {

/// Contacts between one ordered pair of bodies: the first primitive's vertices (point, or edge a) are on `first`.
struct BodyPairContacts {
    int first = 0, second = 0;
    std::vector<ContactPair> contacts;
};

struct ContactSet {
    std::vector<BodyPairContacts> pairs;       ///< in the candidates' order; vertices on the higher body come as a pair of their own
    std::vector<ccd::BodyDistance> distances;  ///< in the candidates' order
    int count = 0;
    double minimum_distance = 0;  ///< of the contacts [m], computed, not proven; infinity if there are none, not finite where a pose is not
};

/// How the contacts of each pair of bodies were counted last (counted_contacts.hpp).
struct ContactPlans {
    struct OfPair {
        int a = 0, b = 0;
        CountingPlan plan;
    };
    std::vector<OfPair> pairs;  ///< in the candidates' order
};

/// Contacts among the candidates at `poses`, plane faces counted once (counted_contacts.hpp). Pairs at or below dmin are contacts too, of
/// no finite potential. Contract: candidates cover `poses`.
/// @param plans  of the same model before; they save time, and change no bit
ContactSet find_contacts(const model::Model& model, const ccd::Candidates& candidates, const std::vector<kinematics::Pose>& poses,
                         ContactPlans* plans = nullptr);

/// Sum of the barrier potential over the contacts; infinity where a pair is at or below dmin, or its distance is not finite.
double barrier_potential(const ContactSet& set, const BarrierParameters& parameters);

/// Adds first and second derivatives (Gauss-Newton part of the Hessian) to per-body sums.
/// hessian.diagonal and gradients must have one entry per body; off-diagonal blocks are inserted as needed and end up sorted.
void add_barrier_derivatives(const ContactSet& set, const std::vector<kinematics::Pose>& poses, const BarrierParameters& parameters,
                             HessianKind kind, std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian);

/// Makes sums for pairs of bodies, make(k, sum) for each, on all threads, and adds them, in their order, to the per-body ones.
/// hessian.off_diagonal stays sorted. @param bodies  their numbers  @param contacts  of all pairs, about
void add_pair_sums(const std::vector<std::array<int, 2>>& bodies, std::size_t contacts,
                   const std::function<void(int k, BodyPairSum& sum)>& make, HessianKind kind,
                   std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian);

/// The bodies of such pairs, for add_pair_sums.
template <class Pairs>
std::vector<std::array<int, 2>> bodies_of(const Pairs& pairs) {
    std::vector<std::array<int, 2>> bodies;
    bodies.reserve(pairs.size());
    for (const auto& pair : pairs) bodies.push_back({pair.first, pair.second});
    return bodies;
}

}  // namespace fettle::core::contact
