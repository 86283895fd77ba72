// SPDX-License-Identifier: MIT
/// Contacts that a simulation for gradients keeps of where its solves ended, so that the adjoint need not look for them again. They are
/// what a search there would find, bit for bit, and nothing is lost with them but time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/contact/contact_set.hpp"

namespace fettle::core::stepper {

struct KeptContacts {
    std::vector<kinematics::Pose> poses;
    contact::ContactSet contacts;                ///< there
    double dmin = 0, dhat = 0, round_reach = 0;  ///< of the model
};

/// A trajectory keeps no more contacts than these: of the later steps none (some 50 megabytes).
inline constexpr std::size_t most_kept_contacts = 100'000;

KeptContacts kept_contacts(const model::Model& model, std::vector<kinematics::Pose> poses, contact::ContactSet contacts);

/// Are they this model's contacts at these poses, as far as can be told: same poses, distances of the barrier and places of the contacts'
/// vertices, bit for bit?
bool are_of(const KeptContacts& kept, const model::Model& model, const std::vector<kinematics::Pose>& poses);

}  // namespace fettle::core::stepper
