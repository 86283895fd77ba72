// SPDX-License-Identifier: MIT
/// Bodies that touch: a lid on its base, whose faces lie on each other to within rounding, of a file's decimals too. Neither a gap nor a
/// clash can be proven of them. What can be: how far they are in each other at most, at all times of a path.
///
/// Let A be closed and wind round every place once or not at all, so that a ball in its material meets none of its surfaces. (Shells that
/// overlap, or cross themselves, have surfaces within the material: of these nothing is proven.) Let A' be the mesh A with every vertex
/// moved by at most d, all within its solid as far as that goes, and let the solids A' and B be proven disjoint. Then no ball of a radius r
/// > d is in both A and B: while A's vertices move to those of A' its surface stays away from the middle of a ball that is in A, for it
/// moves by d and is r away; so A' winds round that middle as A does, and the middle is not in B. In terms of Overlap::depth_lower, the
/// diameter of a ball in both: depth <= 2 d.
#pragma once

#include <optional>

#include "core/clearance/pair_details.hpp"
#include "core/clearance/pair_search.hpp"

namespace fettle::core::clearance {

/// Do the shells of a closed mesh wind round nothing twice: none crosses another or itself, and those within others are cavities, or parts
/// in these? Else a surface may lie in the middle of the material.
bool winds_once(const geometry::Mesh& mesh);

/// Up to which depth bodies count as touching unless someone says another: a hundred-thousandth of the larger one's size [m].
double default_touch_depth(const geometry::Mesh& a, const geometry::Mesh& b);
double default_touch_depth(const PairMotion& pair);

/// Proof that nowhere on the path a ball of the diameter `depth` [m] is in both bodies, where that path begins at `start`.
/// @return how far apart the two stay once one of them is thinner [m]; nothing: it could not be proven, as of bodies neither of which is
///         closed and winds once round its material.
std::optional<double> proven_touch(const PairMotion& pair, const certificate::PairStart& start, double depth, const SearchOptions& search);

struct TouchingArea {
    double area = 0;       ///< [m^2]
    bool is_whole = true;  ///< false: faces were left that were not looked at, of too many
};
/// The area of the faces that lie on each other with their fronts, to within `depth` [m], at s of a segment.
TouchingArea touching_area(const PairMotion& pair, int segment, double s, double depth);

}  // namespace fettle::core::clearance
