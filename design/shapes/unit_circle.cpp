// SPDX-License-Identifier: MIT
#include "fettle/design/shapes/unit_circle.hpp"

#include <cmath>
#include <numbers>

#include "fettle/core/base/contract.hpp"

namespace fettle::design::shapes {
namespace {

// From the nearer end of the first quadrant, so that (cos, sin) of i and of N/4 - i are the same two numbers.
std::array<double, 2> first_quadrant(int i, int segments) {
    const double step = 2 * std::numbers::pi / segments;
    if (8 * i == segments) return {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2};
    if (8 * i < segments) return {std::cos(step * i), std::sin(step * i)};
    const int from_end = segments / 4 - i;  // exact: segments is a multiple of 4
    const double rest = step * from_end;
    return {std::sin(rest), std::cos(rest)};
}

}  // namespace

std::vector<std::array<double, 2>> unit_circle(int segments) {
    FETTLE_ASSERT(segments > 0 && segments % 4 == 0, "segments of a circle are a positive multiple of 4");
    std::vector<std::array<double, 2>> points;
    const int quarter = segments / 4;
    for (int i = 0; i < segments; ++i) {
        const auto [c, s] = first_quadrant(i % quarter, segments);
        switch (i / quarter) {
            case 0:
                points.push_back({c, s});
                break;
            case 1:
                points.push_back({-s, c});
                break;
            case 2:
                points.push_back({-c, -s});
                break;
            default:
                points.push_back({s, -c});
                break;
        }
    }
    return points;
}

double flat_ratio(int segments) { return std::cos(std::numbers::pi / segments); }

}  // namespace fettle::design::shapes
