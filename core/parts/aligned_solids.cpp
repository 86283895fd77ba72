// SPDX-License-Identifier: MIT
#include "core/parts/aligned_solids.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fettle::core::parts {
namespace {

void align(Number Point3::*axis, Solid& a, Solid& b) {
    std::vector<std::pair<Number*, Solid*>> coordinates;
    double largest = 0;
    for (Solid* solid : {&a, &b}) {
        for (Point3& p : solid->vertices) {
            coordinates.push_back({&(p.*axis), solid});
            largest = std::max(largest, std::abs((p.*axis).value));
        }
    }
    const double tolerance = usual_rounding(largest);
    std::stable_sort(coordinates.begin(), coordinates.end(), [](const auto& x, const auto& y) { return x.first->value < y.first->value; });
    for (std::size_t first = 0; first < coordinates.size();) {
        const double least = coordinates[first].first->value, one = std::abs(least) <= tolerance ? 0 : least;
        for (; first < coordinates.size() && coordinates[first].first->value <= one + tolerance; ++first) {
            auto& [x, solid] = coordinates[first];
            const double way = one - x->value;  // exact: they are within a factor of two of each other, or one is 0
            if (way == 0) continue;
            *x = *x + way;
            solid->rounding = std::max(solid->rounding, std::abs(way));
        }
    }
}

}  // namespace

void align(Solid& a, Solid& b) {
    for (const auto axis : {&Point3::x, &Point3::y, &Point3::z}) align(axis, a, b);
}

}  // namespace fettle::core::parts
