// SPDX-License-Identifier: MIT
#include "tests/support/passage_oracle.hpp"

#include <algorithm>

#include "tests/support/exact_ccd.hpp"

namespace fettle::tests::support {
namespace {

using core::geometry::PairType;
using core::geometry::PairVertices;

constexpr double dot_rounding = 1e-13;  // of a dot product of three terms, relative to its factors' size

/// Between closest points of two edges: alternating projections, enough for a guess of a separating direction.
Vector3 edge_gap(const PairVertices& x) {
    const Vector3 a = x[1] - x[0], b = x[3] - x[2];
    double s = 0.5, t = 0.5;
    for (int i = 0; i < 8; ++i) {
        if (b.squaredNorm() > 0) t = std::clamp((x[0] + s * a - x[2]).dot(b) / b.squaredNorm(), 0.0, 1.0);
        if (a.squaredNorm() > 0) s = std::clamp((x[2] + t * b - x[0]).dot(a) / a.squaredNorm(), 0.0, 1.0);
    }
    return x[0] + s * a - (x[2] + t * b);
}

bool separates(const Vector3& direction, int split, const PairVertices& t0, const PairVertices& t1, double apart) {
    double low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY, size = 0;
    for (const PairVertices* x : {&t0, &t1})
        for (int i = 0; i < 4; ++i) {
            const double along = direction.dot((*x)[i]);
            size = std::max(size, (*x)[i].cwiseAbs().maxCoeff());
            double &low = i < split ? low_a : low_b, &high = i < split ? high_a : high_b;
            low = std::min(low, along), high = std::max(high, along);
        }
    const double margin = apart * direction.norm() * (1 + dot_rounding) + dot_rounding * direction.cwiseAbs().maxCoeff() * size;
    return low_a > high_b + margin || low_b > high_a + margin;
}

}  // namespace

bool is_separated_by_plane(PairType type, const PairVertices& t0, const PairVertices& t1, double margin) {
    const auto separated = [&](const Vector3& direction) {
        return separates(direction, type == PairType::edge_edge ? 2 : 1, t0, t1, margin);
    };
    if (separated(Vector3::UnitX()) || separated(Vector3::UnitY()) || separated(Vector3::UnitZ())) return true;
    for (const PairVertices* x : {&t0, &t1}) {
        const PairVertices& v = *x;
        if (type == PairType::edge_edge) {
            if (separated((v[1] - v[0]).cross(v[3] - v[2])) || separated(edge_gap(v))) return true;
        } else if (separated((v[2] - v[1]).cross(v[3] - v[1])) || separated(v[0] - (v[1] + v[2] + v[3]) / 3)) {
            return true;
        }
    }
    return false;
}

double find_passage(PairType type, const MovingVertices& vertices, double s0, double s1, double curvature, double resolution) {
    const PairVertices t0 = vertices(s0), t1 = vertices(s1);
    if (is_separated_by_plane(type, t0, t1, curvature * (s1 - s0) * (s1 - s0))) return -1;
    const double middle = (s0 + s1) / 2;
    if (s1 - s0 <= resolution) return exact_linear_contact(type, t0, t1) ? middle : -1;
    const double first = find_passage(type, vertices, s0, middle, curvature, resolution);
    return first >= 0 ? first : find_passage(type, vertices, middle, s1, curvature, resolution);
}

}  // namespace fettle::tests::support
