// SPDX-License-Identifier: MIT
/// The gap between two bodies as contact measures it (contact/contact_set.hpp), however far apart they are: of what is round between its
/// round surfaces, else between the facets. Contact begins where this gap falls below dmin + dhat. Computed at one configuration, not
/// proven; the proven distance of the meshes is clearance.hpp's.
#pragma once

#include <optional>
#include <vector>

#include "core/contact/contact_pair.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// Where two bodies are nearest.
struct ContactGap {
    int first = 0, second = 0;     ///< bodies: of the contact's first primitive, and of its second
    contact::ContactPair contact;  ///< of any distance; its weight is irrelevant
    double gap = 0;                ///< contact::gap_of(contact) [m]
};

/// The gap between two bodies, each with its pose in `poses`. Where the bodies touch it is the least gap of their contacts.
/// Contract: different bodies that do not pass through each other.
ContactGap contact_gap(const model::Model& model, const std::vector<kinematics::Pose>& poses, int a, int b);

/// The gap between one body and the nearest that it may collide with, or that other one. Nothing: it may collide with none.
std::optional<ContactGap> nearest_contact_gap(const model::Model& model, const std::vector<kinematics::Pose>& poses, int body,
                                              std::optional<int> other);

}  // namespace fettle::core::clearance
