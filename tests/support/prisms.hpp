// SPDX-License-Identifier: MIT
/// Bodies extruded along z, for tests of contact between round surfaces.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/geometry/mesh.hpp"
#include "core/model/model.hpp"
#include "core/setup/round_contact.hpp"

namespace fettle::tests::support {

/// Corners counter-clockwise, all seen from the origin.
using Outline = std::vector<Vector2>;

/// Corners at equal angles, the first at `phase`, each as far from the origin as radius(angle) says.
inline Outline polar_outline(int corners, const std::function<double(double)>& radius, double phase = 0) {
    Outline out;
    for (int k = 0; k < corners; ++k) {
        const double angle = phase + 2 * std::numbers::pi * k / corners;
        out.emplace_back(radius(angle) * std::cos(angle), radius(angle) * std::sin(angle));
    }
    return out;
}

/// Corners on a circle.
inline Outline circle_outline(int corners, double radius, double phase = 0) {
    return polar_outline(
        corners, [radius](double) { return radius; }, phase);
}

/// Half circles about (-half_length, 0) and (half_length, 0), of `corners` facets each, and the straight walls between them.
inline Outline slot_outline(int corners, double radius, double half_length) {
    Outline out;
    for (const double side : {1.0, -1.0})
        for (int k = 0; k <= corners; ++k) {
            const double angle = std::numbers::pi * (static_cast<double>(k) / corners - 0.5);
            out.emplace_back(side * (half_length + radius * std::cos(angle)), side * radius * std::sin(angle));
        }
    return out;
}

/// @param floors  into how many its walls are cut along their height
inline core::geometry::Mesh prism(const Outline& outline, double low, double high, int floors = 1) {
    const int n = count_of(outline), bottom = n * (floors + 1), top = bottom + 1;
    Matrix3X v(3, top + 1);
    std::vector<core::geometry::Triangle> triangles;
    v.col(bottom) << 0, 0, low;
    v.col(top) << 0, 0, high;
    for (int k = 0; k < n; ++k) {
        const int next = (k + 1) % n;
        for (int f = 0; f <= floors; ++f) v.col(f * n + k) << outline[k], low + (high - low) * f / floors;
        for (int f = 0; f < floors; ++f) {
            triangles.push_back({f * n + k, f * n + next, (f + 1) * n + next});
            triangles.push_back({f * n + k, (f + 1) * n + next, (f + 1) * n + k});
        }
        triangles.push_back({bottom, next, k});
        triangles.push_back({top, floors * n + k, floors * n + next});
    }
    return core::geometry::make_mesh("prism", v, triangles);
}

/// A plate with the outline as its hole, `wall` wide round it.
inline core::geometry::Mesh plate_with_hole(const Outline& hole, double wall, double low, double high) {
    const int n = count_of(hole);
    Matrix3X v(3, 4 * n);
    std::vector<core::geometry::Triangle> triangles;
    const auto add_quad = [&](int a, int b, int c, int d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    };
    for (int k = 0; k < n; ++k) {
        const int next = (k + 1) % n;
        const Vector2 outer = (1 + wall / hole[k].norm()) * hole[k];
        v.col(k) << hole[k], low;
        v.col(n + k) << hole[k], high;
        v.col(2 * n + k) << outer, low;
        v.col(3 * n + k) << outer, high;
        add_quad(next, k, n + k, n + next);
        add_quad(2 * n + k, 2 * n + next, 3 * n + next, 3 * n + k);
        add_quad(k, next, 2 * n + next, 2 * n + k);
        add_quad(n + next, n + k, 3 * n + k, 3 * n + next);
    }
    return core::geometry::make_mesh("plate", v, triangles);
}

/// Round contact between all sides, however little room they have. Call it again after moving vertices.
inline void set_round(core::model::Model& model) { core::setup::add_round_contact(true, std::vector<core::model::FacetSides>{}, model); }

}  // namespace fettle::tests::support
