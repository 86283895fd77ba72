// SPDX-License-Identifier: MIT
/// What a pair's closest points lie in: vertices, edges, faces. Contacts with the same closest features have the same distance with the
/// same derivatives, whatever primitives they were found by.
#pragma once

#include <array>

#include "fettle/core/contact/contact_pair.hpp"

namespace fettle::core::contact {

/// One to three vertices of a body, ascending; -1 for none.
using Feature = std::array<int, 3>;

/// Of a point_triangle pair: what of the second primitive its closest point lies in.
Feature closest_feature(const ContactPair& pair);

/// The same contact as one of a vertex and `feature`, closest_feature(pair): over an edge or a vertex the corners of the face coincide.
ContactPair on_feature(const ContactPair& pair, const Feature& feature);

/// Of an edge_edge pair: which of its vertices, 0 to 3, closest points are, if any are: one of the first edge before one of the second.
/// Then the contact is that of this vertex with the other edge, but where the mollifier acts, which feels more than the distance.
/// -1: none, or the mollifier acts.
int closest_end(const ContactPair& pair);

/// That contact, as a point_triangle pair. @param end  closest_end(pair), not -1
ContactPair on_end(const ContactPair& pair, int end);

/// closest_feature(on_end(pair, end)).
Feature feature_opposite(const ContactPair& pair, int end);

/// The contact of two vertices, their bodies the other way round. @param pair  as on_feature gives it
ContactPair swapped(const ContactPair& pair);

}  // namespace fettle::core::contact
