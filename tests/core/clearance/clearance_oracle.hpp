// SPDX-License-Identifier: MIT
/// What certified clearances are held against: dense sampling of the path in extended precision (64-bit mantissa), sharing no code with
/// core/clearance: rotations by the textbook formula, triangle distances by region case analysis and alternating projection.
/// And the random moving solids to do it with.
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/clearance/pair_search.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::tests::clearance {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using Real33 = Eigen::Matrix<Real, 3, 3>;

struct Solid {
    core::geometry::Mesh mesh;
    std::shared_ptr<core::geometry::BodyHierarchy> hierarchy;
    core::clearance::PieceTree search() const { return core::clearance::make_piece_tree(mesh, *hierarchy); }
    double radius() const { return hierarchy->nodes()[0].radius; }
};

inline Solid make_solid(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles) {
    Solid solid;
    solid.mesh = core::geometry::make_mesh("solid", vertices, triangles);
    solid.hierarchy = std::make_shared<core::geometry::BodyHierarchy>(solid.mesh);
    return solid;
}

/// Prism with n sides between z = -height/2 and height/2; n = 4 with a turn of 45 degrees is a box.
inline Solid prism(int n, double radius, double height) {
    Matrix3X x(3, 2 * n);
    std::vector<core::geometry::Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * i / n;
        x.col(i) << radius * std::cos(angle), radius * std::sin(angle), -height / 2;
        x.col(n + i) << radius * std::cos(angle), radius * std::sin(angle), height / 2;
        const int j = (i + 1) % n;
        triangles.push_back({i, j, n + j});
        triangles.push_back({i, n + j, n + i});
        if (i >= 2) {
            triangles.push_back({0, i, i - 1});
            triangles.push_back({n, n + i - 1, n + i});
        }
    }
    return make_solid(x, triangles);
}

inline Solid box(const Vector3& half) {
    Matrix3X x(3, 8);
    for (int i = 0; i < 8; ++i)
        x.col(i) << ((i & 1) ? half.x() : -half.x()), ((i & 2) ? half.y() : -half.y()), ((i & 4) ? half.z() : -half.z());
    return make_solid(x, {{0, 2, 1},
                          {1, 2, 3},
                          {4, 5, 6},
                          {5, 7, 6},
                          {0, 1, 4},
                          {1, 5, 4},
                          {2, 6, 3},
                          {3, 6, 7},
                          {0, 4, 2},
                          {2, 4, 6},
                          {1, 3, 5},
                          {3, 7, 5}});
}

inline Solid tetrahedron(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> u(-size, size);
    Matrix3X x(3, 4);
    for (int i = 0; i < 12; ++i) x(i % 3, i / 3) = u(random);
    return make_solid(x, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

/// Ring around the z axis with an n-sided bore and outside.
inline Solid ring(int n, double inner, double outer, double height) {
    Matrix3X x(3, 4 * n);
    std::vector<core::geometry::Triangle> triangles;
    const auto quad = [&](int a, int b, int c, int d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    };
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * i / n, c = std::cos(angle), s = std::sin(angle);
        x.col(i) << inner * c, inner * s, -height / 2;
        x.col(n + i) << inner * c, inner * s, height / 2;
        x.col(2 * n + i) << outer * c, outer * s, -height / 2;
        x.col(3 * n + i) << outer * c, outer * s, height / 2;
        const int j = (i + 1) % n;
        quad(i, n + i, n + j, j);
        quad(2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i);
        quad(n + i, 3 * n + i, 3 * n + j, n + j);
        quad(i, j, 2 * n + j, 2 * n + i);
    }
    return make_solid(x, triangles);
}

inline Real33 oracle_rotation(const Real3& t) {
    const Real x = std::sqrt(t.dot(t));
    Real33 k;
    k << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    if (x < 1e-9L) return Real33::Identity() + k + k * k / 2;
    const Real half = std::sin(x / 2);
    return Real33::Identity() + k * (std::sin(x) / x) + k * k * (2 * half * half / (x * x));
}

using RealVertices = Eigen::Matrix<Real, 3, Eigen::Dynamic>;

inline RealVertices oracle_vertices(const core::kinematics::PathSegment& p, const Matrix3X& X, Real s) {
    const Real3 t = p.rotation_vector_t0.cast<Real>() + s * p.rotation_vector_step.cast<Real>();
    const Real33 r = oracle_rotation(t) * p.base.cast<Real>();
    const Real3 q = p.position_t0.cast<Real>() + s * p.position_step.cast<Real>();
    return (r * X.cast<Real>()).colwise() + q;
}

inline Real3 oracle_closest_on_triangle(const Real3& p, const Real3& a, const Real3& b, const Real3& c) {
    const Real3 ab = b - a, ac = c - a, ap = p - a;
    const Real d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Real3 bp = p - b;
    const Real d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const Real vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
    const Real3 cp = p - c;
    const Real d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const Real vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
    const Real va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

inline Real oracle_edge_distance(const Real3& p1, const Real3& q1, const Real3& p2, const Real3& q2) {
    const Real3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
    const Real a = d1.dot(d1), e = d2.dot(d2), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2), denominator = a * e - b * b;
    const auto clamp = [](Real x) { return std::min<Real>(std::max<Real>(x, 0), 1); };
    Real s = denominator > 0 ? clamp((b * f - c * e) / denominator) : 0;
    Real t = clamp((b * s + f) / e);
    s = clamp((b * t - c) / a);
    return std::sqrt((p1 + s * d1 - p2 - t * d2).squaredNorm());
}

/// Least distance between vertices, edges and faces of two placed meshes (of solids that do not intersect: the distance).
inline Real oracle_distance(const core::geometry::Mesh& a, const RealVertices& x, const core::geometry::Mesh& b, const RealVertices& y) {
    Real least = std::numeric_limits<Real>::infinity();
    const auto points = [&](const RealVertices& p, const core::geometry::Mesh& mesh, const RealVertices& v) {
        for (int i = 0; i < p.cols(); ++i)
            for (const auto& t : mesh.triangles)
                least = std::min(least, (p.col(i) - oracle_closest_on_triangle(p.col(i), v.col(t[0]), v.col(t[1]), v.col(t[2]))).norm());
    };
    points(x, b, y);
    points(y, a, x);
    for (const auto& e : a.edges)
        for (const auto& f : b.edges) least = std::min(least, oracle_edge_distance(x.col(e[0]), x.col(e[1]), y.col(f[0]), y.col(f[1])));
    return least;
}

struct MovingPair {
    Solid a, b;
    core::kinematics::PathSegment path_a, path_b;
    core::clearance::PairSegment segment() const { return core::clearance::pair_segment(path_a, path_b, a.radius(), b.radius()); }
    Real distance_at(Real s) const {
        return oracle_distance(a.mesh, oracle_vertices(path_a, a.mesh.vertices, s), b.mesh, oracle_vertices(path_b, b.mesh.vertices, s));
    }
};

/// Least sampled distance: equal steps, then closer and closer around the best.
inline Real sampled_minimum(const MovingPair& pair, int samples, int refinements) {
    Real best = std::numeric_limits<Real>::infinity(), at = 0, step = Real(1) / samples;
    const auto sample = [&](Real s) {
        const Real d = s >= 0 && s <= 1 ? pair.distance_at(s) : best;
        if (d < best) {
            best = d;
            at = s;
        }
    };
    for (int i = 0; i <= samples; ++i) sample(i * step);
    for (int r = 0; r < refinements; ++r, step /= 3) {
        const Real center = at;
        for (int i = -3; i <= 3; ++i) sample(center + i * step / 3);
    }
    return best;
}

inline Vector3 random_vector(std::mt19937& random, double size) {
    std::normal_distribution<double> normal;
    return size * Vector3(normal(random), normal(random), normal(random)).normalized();
}

inline Solid random_solid(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> u(0.2, 1);
    switch (random() % 4) {
        case 0:
            return box(size * Vector3(u(random), u(random), u(random)));
        case 1:
            return prism(3 + static_cast<int>(random() % 6), size * u(random), size * 2 * u(random));
        case 2:
            return tetrahedron(random, size);
        default:
            return box(size * Vector3(1, u(random), 0.01));  // a thin plate
    }
}

/// Two solids of the given size passing each other near `origin`, turning by up to `turn` rad, close but usually without touching.
inline MovingPair random_pair(std::mt19937& random, double size, double turn, const Vector3& origin) {
    std::uniform_real_distribution<double> u(0, 1);
    MovingPair pair{random_solid(random, size), random_solid(random, size), {}, {}};
    const auto place = [&](core::kinematics::PathSegment& p) {
        p.base = core::kinematics::rotation(random_vector(random, 3 * u(random)));
        p.rotation_vector_t0 = random() % 2 ? random_vector(random, turn * u(random)) : Vector3(0, 0, 0);
        p.rotation_vector_step = random() % 8 ? random_vector(random, turn * u(random)) : Vector3(0, 0, 0);
        p.position_t0 = origin;
    };
    place(pair.path_a);
    place(pair.path_b);
    const Vector3 away = random_vector(random, (pair.a.radius() + pair.b.radius()) * (0.55 + 0.5 * u(random)));
    const Vector3 along = away.cross(random_vector(random, 1)).normalized() * (size * 4 * u(random));
    pair.path_b.position_t0 = origin + away - 0.5 * along;
    pair.path_b.position_step = along;
    if (random() % 2) pair.path_a.position_step = random_vector(random, 0.2 * size);
    return pair;
}

}  // namespace fettle::tests::clearance
