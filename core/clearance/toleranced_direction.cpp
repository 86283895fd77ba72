// SPDX-License-Identifier: MIT
#include "core/clearance/toleranced_direction.hpp"

#include <cmath>
#include <limits>

#include "core/clearance/segment_bound.hpp"
#include "core/clearance/simplex.hpp"

namespace fettle::core::clearance {
namespace {

using certificate::Model3;

constexpr int most_supports = 24;

Vector3 model_center(const Model3& x) { return {x[0].center, x[1].center, x[2].center}; }
Vector3 model_slope(const Model3& x, std::size_t k) { return {x[0].slopes[k], x[1].slopes[k], x[2].slopes[k]}; }

}  // namespace

DifferenceHull::DifferenceHull(const certificate::PlacedPair& at, std::span<const int> a, std::span<const int> b, int variables)
    : variables_(static_cast<std::size_t>(variables)) {
    std::vector<Model3> of_a, of_b;
    for (const int v : a) of_a.push_back(times(at.rotation, at.models->a[v]) + at.place);
    for (const int v : b) of_b.push_back(at.models->b[v]);
    for (const Model3& x : of_a)
        for (const Model3& y : of_b) {
            Difference& d = differences_.emplace_back();
            d.center = model_center(x) - model_center(y);
            for (std::size_t k = 0; k < variables_; ++k) d.slopes[k] = model_slope(x, k) - model_slope(y, k);
        }
}

Vector3 DifferenceHull::support(const Vector3& n) {
    double least = std::numeric_limits<double>::infinity();
    const Difference* best = &differences_.front();
    for (const Difference& d : differences_) {
        double value = n.dot(d.center);
        for (std::size_t k = 0; k < variables_; ++k) value -= std::abs(n.dot(d.slopes[k]));
        if (!(value < least)) continue;
        least = value;
        best = &d;
    }
    Vector3 out = best->center;
    for (std::size_t k = 0; k < variables_; ++k) {
        corner_[k] = n.dot(best->slopes[k]) > 0 ? -1 : 1;
        out += corner_[k] * best->slopes[k];
    }
    return out;
}

Vector3 DifferenceHull::direction(const Vector3& first, double tolerance) {
    std::array<Vector3, 4> simplex;
    simplex[0] = support(first);
    int count = 1;
    Vector3 best = first;
    double apart = first.dot(simplex[0]);
    for (int round = 0; round < most_supports; ++round) {
        const SimplexPoint nearest = nearest_to_origin(simplex, count);
        const double distance = nearest.point.norm();
        if (!(distance > 0)) return Vector3::Zero();
        if (!(distance - apart > tolerance)) break;
        const Vector3 n = unit_direction(nearest.point);
        int kept = 0;
        for (int i = 0; i < count; ++i)
            if (nearest.weight[static_cast<std::size_t>(i)] > 0)
                simplex[static_cast<std::size_t>(kept++)] = simplex[static_cast<std::size_t>(i)];
        if (kept == 4) return Vector3::Zero();
        const Vector3 next = support(n);
        const double along = n.dot(next);
        if (along > apart) {
            apart = along;
            best = n;
        }
        count = kept;
        simplex[static_cast<std::size_t>(count++)] = next;
    }
    support(best);
    return best;
}

}  // namespace fettle::core::clearance
