// SPDX-License-Identifier: MIT
/// One vertex over the faces of a body: a plane face is one contact, however it is cut into triangles.
/// Inclusion and exclusion over the faces T near the vertex, the flat edges e and the flat vertices w between them
/// (geometry/flat_features.hpp):
///   sum_T b(T) - sum_e b(e) + sum_w b(w).
/// Over a plane face without notches all terms but the one of the nearest place cancel; round notches what remains is smooth, with a corner
/// that may count -1. Pairs with the same closest feature (face, edge or vertex) have the same distance with the same derivatives, so that
/// they are one contact, weighted by how often the feature counts. Source of the idea: Li, Ferguson, Schneider, Langlois, Zorin, Panozzo,
/// Jiang, Kaufman, "Convergent Incremental Potential Contact", 2023 (section on improved max approximation).
#pragma once

#include <span>
#include <vector>

#include "fettle/core/contact/contact_pair.hpp"
#include "fettle/core/geometry/flat_features.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::contact {

/// The body whose faces they are.
struct FaceSide {
    const model::Body& body;
    const kinematics::Pose& pose;
    const geometry::FlatFeatures* flat = nullptr;  ///< null: nothing is
    double activation = 0;                         ///< [m]
    bool by_element = false;  ///< keep faces, edges and vertices apart, for functions of more than the distance at one time
};

/// @param near  all pairs of one vertex with faces of the body that are closer than the activation distance, `closest` filled
/// @param out   what counts is appended
void count_faces_once(const FaceSide& side, std::span<const ContactPair> near, std::vector<ContactPair>& out);

}  // namespace fettle::core::contact
