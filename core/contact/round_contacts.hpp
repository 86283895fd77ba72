// SPDX-License-Identifier: MIT
/// Contacts between round surfaces of two bodies whose sides run (nearly) along one direction: pins in bores, followers on cams, gears.
///
/// There the sections are curves of arcs and lines (geometry/round_surfaces.hpp), and the gap of two of their pieces is that of an arc's
/// centre line from the other's, or from a plane, less the radii:
///   gap = |r| - R  outside,   gap = R - |r|  inside,   r between the closest points of the centre lines (or of one and a plane),
/// R the sum or difference of the radii and of both covers. As arcs go over into one another without corners, so do the gap and its
/// derivative where a contact goes from one facet to the next: the force is that of the smooth surface.
///
/// A line of contact is counted at its two ends, where the shorter of the sides ends: a point of one centre line against the other line or
/// plane, or the border of a plane against a centre line. A circle within a circle has in each the contact on the far side too, which makes
/// the potential smooth where both have one centre.
///
/// In the section a flat that lies on a flat has contacts at both ends of what they share, as long as it is long enough that the farther
/// one ends beyond the activation distance (its length squared above activation (activation + 2 radius of the corner)).
///
/// The primitives of these sides then have no contacts of their own with each other, where one closest point is beside the other's side.
#pragma once

#include <vector>

#include "core/contact/near_search.hpp"

namespace fettle::core::contact {

/// Directions of sides that make less than this angle's sine are one direction.
inline constexpr double largest_slant = 0.1;

/// Takes away from `near` what round surfaces stand for.
/// Appends the round contacts: `forward` those whose first primitive is on list.a, `backward` the others.
/// @return the least gap, with its sign; infinity if there is none
double find_round_contacts(const NearAt& at, NearPairs& near, std::vector<ContactPair>& forward, std::vector<ContactPair>& backward);

/// How far the round surfaces of two sides are apart.
struct SidesGap {
    int side_a = 0, side_b = 0;  ///< into RoundSurfaces::sides of list.a and list.b
    double gap = 0;              ///< with its sign [m]; infinity if they have no contact
    double covers = 0;           ///< of both [m]
};

/// The gaps of all sides of the two bodies that meet here.
std::vector<SidesGap> gaps_of_sides(const NearAt& at);

}  // namespace fettle::core::contact
