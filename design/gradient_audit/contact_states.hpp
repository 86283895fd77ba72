// SPDX-License-Identifier: MIT
/// Which features of which bodies are in contact at the end of each step of a simulation, and what they do there. Contacts of the barrier
/// (core/contact/contact_set.hpp) by what a designer sees: a plane face is one feature, however it is cut into triangles.
#pragma once

#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"

namespace fettle::design::gradient_audit {

/// Vertices of a body, ascending: one, the two of an edge, or those of a whole plane face.
struct ContactFeature {
    enum class Kind { vertex, edge, face };
    Kind kind = Kind::vertex;
    std::vector<int> vertices;
    bool operator==(const ContactFeature&) const = default;
};
const char* to_string(ContactFeature::Kind kind);

/// A vertex in common: of neighbours, or the same.
bool adjoin(const ContactFeature& a, const ContactFeature& b);

struct ContactState {
    int a = 0, b = 0;  ///< bodies, a < b
    ContactFeature on_a, on_b;
    Vector3 place = Vector3::Zero();  ///< between the closest points, world [m]
    bool is_mollified = false;        ///< two edges so nearly parallel that their contact is faded out (core/contact/barrier.hpp)
    bool slides = false;              ///< with friction: faster than eps_v, from the step's slip reference to its end
};

/// [step], each sorted by bodies and features. Contract: the trajectory is the model's.
std::vector<std::vector<ContactState>> contact_states(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// Before another, by bodies and features: 0 for the same contact.
int compare_contacts(const ContactState& x, const ContactState& y);

}  // namespace fettle::design::gradient_audit
