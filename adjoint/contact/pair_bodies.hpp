// SPDX-License-Identifier: MIT
/// A contact's four vertices and the bodies that they are on.
#pragma once

#include <array>

#include "fettle/core/contact/contact_set.hpp"

namespace fettle::adjoint::contact {

/// One vector for each of a pair's vertices.
using Four = std::array<Vector3, 4>;

inline double dot(const Four& a, const Four& b) { return a[0].dot(b[0]) + a[1].dot(b[1]) + a[2].dot(b[2]) + a[3].dot(b[3]); }

/// The body of each vertex.
inline std::array<int, 4> bodies_of(const core::contact::BodyPairContacts& list, const core::contact::ContactPair& pair) {
    std::array<int, 4> body;
    for (int i = 0; i < 4; ++i) body[i] = i < first_count(pair.type) ? list.first : list.second;
    return body;
}

/// Each vertex in its own body's frame.
inline Four undeformed(const core::model::Model& model, const std::array<int, 4>& body, const core::contact::ContactPair& pair) {
    Four X;
    for (int i = 0; i < 4; ++i) X[i] = model.bodies[body[i]].mesh.vertices.col(pair.vertex[i]);
    return X;
}

}  // namespace fettle::adjoint::contact
