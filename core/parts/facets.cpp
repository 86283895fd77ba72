// SPDX-License-Identifier: MIT
#include "fettle/core/parts/facets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fettle/core/parts/point.hpp"

namespace fettle::core::parts {
namespace {

constexpr double most_segments = 100000;

}  // namespace

Lean opposite(Lean lean) {
    if (lean == Lean::cover) return Lean::within;
    return lean == Lean::within ? Lean::cover : Lean::through;
}

int segments_of(const Facets& facets, double radius, double angle) {
    angle = std::abs(angle);
    const bool whole = angle >= full_turn * (1 - 1e-12);
    const auto counted = [](double count) { return static_cast<int>(std::min(most_segments, std::max(1.0, std::ceil(count - 1e-9)))); };
    if (!(facets.chord > 0)) return std::max(whole ? 3 : 1, counted(facets.segments * angle / full_turn));
    // r (1 / cos(half) - 1) <= chord, the larger of the two deviations; a flat turns by at most 120 degrees.
    const double half = std::min(std::numbers::pi / 3, std::acos(radius / (radius + facets.chord)));
    const int least = counted(angle / (2 * half));
    return whole ? std::max(4, (least + 3) / 4 * 4) : least;
}

}  // namespace fettle::core::parts
