// SPDX-License-Identifier: MIT
/// Meshes of bodies of revolution about the z axis: the profile's corners on n half planes.
#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::tests::support {

struct RoundMesh {
    std::vector<Vector3> vertices;
    std::vector<core::geometry::Triangle> triangles;

    double volume() const {
        double out = 0;
        for (const auto& t : triangles) out += vertices[t[0]].dot(vertices[t[1]].cross(vertices[t[2]])) / 6;
        return out;
    }
    void turn_inside_out() {
        for (auto& t : triangles) std::swap(t[1], t[2]);
    }
    void add(const RoundMesh& other) {
        const int first = static_cast<int>(vertices.size());
        vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
        for (const auto& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    core::geometry::Mesh mesh() const {
        Matrix3X x(3, static_cast<Eigen::Index>(vertices.size()));
        for (std::size_t k = 0; k < vertices.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = vertices[k];
        return core::geometry::make_mesh("round", x, triangles);
    }
};

/// @param profile  (r, z): a closed polygon away from the axis, or a line from the axis to the axis; either way round
inline RoundMesh revolved(const std::vector<Vector2>& profile, int n) {
    RoundMesh out;
    const std::size_t count = profile.size();
    const bool is_open = profile.front().x() == 0;
    std::vector<std::vector<int>> rows;
    for (const Vector2& p : profile) {
        rows.emplace_back();
        for (int i = 0; i < n; ++i) {
            if (p.x() > 0 || i == 0) {
                const double angle = 2 * M_PI * i / n;
                out.vertices.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
            }
            rows.back().push_back(static_cast<int>(out.vertices.size()) - 1);
        }
    }
    for (std::size_t k = 0; k + (is_open ? 1 : 0) < count; ++k) {
        const auto &low = rows[k], &high = rows[(k + 1) % count];
        for (std::size_t i = 0; i < low.size(); ++i) {
            const std::size_t j = (i + 1) % low.size();
            if (low[i] != low[j]) out.triangles.push_back({low[i], low[j], high[j]});
            if (high[i] != high[j]) out.triangles.push_back({low[i], high[j], high[i]});
        }
    }
    if (out.volume() < 0) out.turn_inside_out();
    return out;
}

/// A sphere about the origin, of rows of corners from pole to pole.
inline RoundMesh ball(double radius, int rows, int n) {
    std::vector<Vector2> profile;
    for (int k = 0; k <= rows; ++k) {
        const double angle = M_PI * k / rows - M_PI / 2;
        profile.emplace_back(k == 0 || k == rows ? 0 : radius * std::cos(angle), radius * std::sin(angle));
    }
    return revolved(profile, n);
}

/// A closed shell between two spheres.
inline RoundMesh shell(double inner, double outer, int rows, int n) {
    RoundMesh out = ball(outer, rows, n), hollow = ball(inner, rows, n);
    hollow.turn_inside_out();
    out.add(hollow);
    return out;
}

}  // namespace fettle::tests::support
