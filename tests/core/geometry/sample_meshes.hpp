// SPDX-License-Identifier: MIT
/// Closed meshes with known integrals, for the tests of core/geometry and adjoint/geometry.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/mesh.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::tests {

using support::box_mesh;

/// Torus about z: centre circle `major`, tube `minor`, n x n quads cut in two.
inline core::geometry::Mesh torus_mesh(double major, double minor, int n) {
    Matrix3X v(3, n * n);
    std::vector<core::geometry::Triangle> triangles;
    const double step = 2 * M_PI / n;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double radius = major + minor * std::cos(step * j);
            v.col(i * n + j) << radius * std::cos(step * i), radius * std::sin(step * i), minor * std::sin(step * j);
            const int a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    }
    return core::geometry::make_mesh("torus", v, triangles);
}

/// Ellipsoid with the given half axes: poles, n - 1 rings of 2 n vertices.
inline core::geometry::Mesh ellipsoid_mesh(const Vector3& axes, int n) {
    const int m = 2 * n;
    Matrix3X v(3, (n - 1) * m + 2);
    for (int i = 1; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            const double polar = M_PI * i / n, azimuth = 2 * M_PI * j / m;
            v.col((i - 1) * m + j) << std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar);
        }
    }
    const int north = (n - 1) * m, south = north + 1;
    v.col(north) << 0, 0, 1;
    v.col(south) << 0, 0, -1;
    std::vector<core::geometry::Triangle> triangles;
    for (int j = 0; j < m; ++j) {
        const int k = (j + 1) % m;
        triangles.push_back({north, j, k});
        for (int i = 0; i + 2 < n; ++i) {
            triangles.push_back({i * m + j, (i + 1) * m + j, (i + 1) * m + k});
            triangles.push_back({i * m + j, (i + 1) * m + k, i * m + k});
        }
        triangles.push_back({(n - 2) * m + j, south, (n - 2) * m + k});
    }
    return core::geometry::make_mesh("ellipsoid", axes.asDiagonal() * v, triangles);
}

/// The meshes side by side in one mesh, each with its own vertices.
inline core::geometry::Mesh joined(const core::geometry::Mesh& a, const core::geometry::Mesh& b) {
    Matrix3X v(3, a.vertices.cols() + b.vertices.cols());
    v << a.vertices, b.vertices;
    std::vector<core::geometry::Triangle> triangles = a.triangles;
    const int shift = static_cast<int>(a.vertices.cols());
    for (const auto& t : b.triangles) triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    return core::geometry::make_mesh("joined", v, triangles);
}

/// The same surface seen from the other side.
inline core::geometry::Mesh inside_out(core::geometry::Mesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    core::geometry::build_connectivity(mesh);
    return mesh;
}

inline Matrix3X random_matrix(int columns, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Matrix3X result(3, columns);
    for (int j = 0; j < columns; ++j) {
        for (int i = 0; i < 3; ++i) result(i, j) = uniform(random);
    }
    return result;
}

}  // namespace fettle::tests
