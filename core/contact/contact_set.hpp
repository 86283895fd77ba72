// SPDX-License-Identifier: MIT
/// The pairs that are closer than the activation distance at one configuration, and the barrier potential summed over them.
/// Contacts are ordered by their primitives, so that sums do not depend on how and when the candidates were found.
#pragma once

#include <vector>

#include "fettle/core/contact/barrier.hpp"
#include "fettle/core/contact/candidates.hpp"
#include "fettle/core/contact/contact_pair.hpp"
#include "fettle/core/contact/counted_contacts.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"

namespace fettle::core::contact {

/// Contacts between one ordered pair of bodies: the first primitive's vertices (point, or edge a) are on `first`.
struct BodyPairContacts {
    int first = 0, second = 0;
    std::vector<ContactPair> contacts;
};

struct ContactSet {
    std::vector<BodyPairContacts> pairs;  ///< in the candidates' order; vertices on the higher body come as a pair of their own
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
ContactSet find_contacts(const model::Model& model, const Candidates& candidates, const std::vector<kinematics::Pose>& poses,
                         ContactPlans* plans = nullptr);

/// Sum of the barrier potential over the contacts; infinity where a pair is at or below dmin, or its distance is not finite.
double barrier_potential(const ContactSet& set, const BarrierParameters& parameters);

/// Adds first and second derivatives (Gauss-Newton part of the Hessian) to per-body sums.
/// hessian.diagonal and gradients must have one entry per body; off-diagonal blocks are inserted as needed and end up sorted.
void add_barrier_derivatives(const ContactSet& set, const std::vector<kinematics::Pose>& poses, const BarrierParameters& parameters,
                             HessianKind kind, std::vector<kinematics::PoseGradient>& gradients, kinematics::BlockHessian& hessian);

/// Adds one pair of bodies' sums to the per-body ones. hessian.off_diagonal stays sorted.
void add_body_pair(int first, int second, const BodyPairSum& sum, HessianKind kind, std::vector<kinematics::PoseGradient>& gradients,
                   kinematics::BlockHessian& hessian);

}  // namespace fettle::core::contact
