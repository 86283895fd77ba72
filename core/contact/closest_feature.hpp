// SPDX-License-Identifier: MIT
/// What a pair's closest points lie in: vertices, edges, faces. Contacts with the same closest features have the same distance with the
/// same derivatives, whatever primitives they were found by.
#pragma once

#include <array>

#include "core/contact/contact_pair.hpp"

namespace fettle::core::contact {

/// One to three vertices of a body, ascending; -1 for none.
using Feature = std::array<int, 3>;

/// The feature of the second primitive in which a point_triangle pair's closest point lies.
Feature closest_feature(const ContactPair& pair);

/// Makes it the same contact as one of a vertex and `feature`, closest_feature(pair): over an edge or a vertex the corners of the face
/// coincide.
void put_on_feature(const Feature& feature, ContactPair& pair);

/// Which of an edge_edge pair's vertices, 0 to 3, closest points are, if any are: one of the first edge before one of the second.
/// Then the contact is that of this vertex with the other edge, but where the mollifier acts, which feels more than the distance.
/// -1: none, or the mollifier acts.
int closest_end(const ContactPair& pair);

/// Makes it that contact, as a point_triangle pair. @param end  closest_end(pair), not -1
void put_on_end(int end, ContactPair& pair);

/// The closest feature of what put_on_end makes of it.
Feature feature_opposite(const ContactPair& pair, int end);

/// Makes it the contact of two vertices, their bodies the other way round. @param pair  as put_on_feature leaves it
void swap_bodies(ContactPair& pair);

}  // namespace fettle::core::contact
