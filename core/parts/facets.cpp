// SPDX-License-Identifier: MIT
#include "core/parts/facets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parts/point.hpp"

namespace fettle::core::parts {
Lean opposite(Lean lean) {
    if (lean == Lean::cover) return Lean::within;
    return lean == Lean::within ? Lean::cover : Lean::through;
}

double segments_wanted(const Facets& facets, double radius, double angle) {
    angle = std::abs(angle);
    const bool whole = angle >= full_turn * (1 - 1e-12);
    const auto counted = [](double count) { return std::max(1.0, std::ceil(count - 1e-9)); };
    if (!(facets.chord > 0)) return std::max(whole ? 3.0 : 1.0, counted(facets.segments * angle / full_turn));
    // r (1 / cos(half) - 1) <= chord, the larger of the two deviations; a flat turns by at most 120 degrees.
    const double half = std::min(std::numbers::pi / 3, std::acos(radius / (radius + facets.chord)));
    const double least = counted(angle / (2 * half));
    return whole ? std::max(4.0, std::ceil(least / 4) * 4) : least;
}

int segments_of(const Facets& facets, double radius, double angle) {
    return static_cast<int>(std::min<double>(most_segments, segments_wanted(facets, radius, angle)));
}

}  // namespace fettle::core::parts
