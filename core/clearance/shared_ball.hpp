// SPDX-License-Identifier: MIT
/// Do two solids overlap somewhere in a box of variables, where a search (box_search.hpp) found that their surfaces meet and no more? The
/// surfaces of flush parts need not pass through each other for that: no edge of one goes through a face of the other but at its border.
/// Looked for is a ball in both that is larger than a touch, where the surfaces meet, beside it along each variable, and at the corners of
/// the box (of up to four variables): by few cells first, then, of meshes that are cut soon, by what the two have in common (overlap.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/clearance/overlap.hpp"

namespace fettle::core::clearance {

/// @param place_of  (const Variables&, use) calls use(SolidBody a, SolidBody b, PairSegment held) with the bodies as they are there
/// @param at        Where the surfaces meet; becomes the place, of those looked at, where the two share most.
/// @return          whether a ball of a diameter greater than `touch` [m] was found in both
template <class Variables, class PlaceOf>
bool find_shared_ball(const Variables& low, const Variables& high, int variables, double touch, const PlaceOf& place_of, Variables& at) {
    constexpr std::size_t few_triangles = 2000;
    constexpr int few_cells = 256;
    std::vector<Variables> places{at};
    for (double step = 0.125; step > 1e-5; step *= 0.5)
        for (std::size_t k = 0; k < static_cast<std::size_t>(variables); ++k)
            for (const double sign : {-1.0, 1.0}) {
                places.push_back(at);
                places.back()[k] = std::clamp(at[k] + sign * step * (high[k] - low[k]), low[k], high[k]);
            }
    constexpr int most_with_corners = 4;
    for (unsigned corner = 0; variables <= most_with_corners && corner < 1U << static_cast<unsigned>(variables); ++corner) {
        places.push_back(at);
        for (std::size_t k = 0; k < static_cast<std::size_t>(variables); ++k) places.back()[k] = (corner >> k & 1U) != 0 ? high[k] : low[k];
    }
    double largest = 0;  // of the volumes that are shared: a ball is as large anywhere in a part that is wholly within the other
    for (const bool exactly : {false, true}) {
        for (std::size_t i = 0; i < places.size(); ++i)
            place_of(places[i], [&](const SolidBody& a, const SolidBody& b, const PairSegment& held) {
                if (exactly && i > 0 && a.tree.mesh->triangles.size() + b.tree.mesh->triangles.size() > few_triangles) return;
                const auto overlap = (exactly ? measured_overlap : overlap_at)(a, b, held, 0, few_cells);
                if (!overlap || !(overlap->depth_lower > touch) || !(overlap->volume_lower > largest)) return;
                largest = overlap->volume_lower;
                at = places[i];
            });
        if (largest > 0) return true;
    }
    return false;
}

}  // namespace fettle::core::clearance
