// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mass_moments.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

namespace fettle::core::geometry {
namespace {

/// a a^T + b b^T + c c^T + S S^T and S = a + b + c: the part that tetrahedra and triangles share.
struct CornerSums {
    Matrix3 second;
    Vector3 first;
};

CornerSums corner_sums(const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 sum = a + b + c;
    return {a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose(), sum};
}

/// Of the tetrahedron (0, a, b, c), V = det(a, b, c) / 6: int x = V/4 S, int x x^T = V/20 (a a^T + b b^T + c c^T + S S^T).
struct TetrahedronSums {
    Matrix3 second = Matrix3::Zero();
    Vector3 first = Vector3::Zero();
    double zeroth = 0;

    void add(const Vector3& a, const Vector3& b, const Vector3& c) {
        const double determinant = a.dot(b.cross(c));
        const CornerSums sums = corner_sums(a, b, c);
        second += determinant * sums.second;
        first += determinant * sums.first;
        zeroth += determinant;
    }
};

TetrahedronSums tetrahedron_sums(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    TetrahedronSums sums;
    for (const Triangle& t : triangles) sums.add(vertices.col(t[0]), vertices.col(t[1]), vertices.col(t[2]));
    return sums;
}

/// Edges of triangles that have fewer reverses than copies, in order, each as often as a reverse is missing.
std::vector<Edge> boundary_chain(const std::vector<Triangle>& triangles) {
    struct DirectedEdge {
        Edge ends;      ///< the smaller index first
        int direction;  ///< 1, or -1 where the triangle has it the other way round
    };
    std::vector<DirectedEdge> all;
    all.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) all.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
        }
    }
    std::sort(all.begin(), all.end(), [](const DirectedEdge& a, const DirectedEdge& b) { return a.ends < b.ends; });
    std::vector<Edge> chain;
    for (std::size_t i = 0; i < all.size();) {
        const Edge ends = all[i].ends;
        int balance = 0;
        for (; i < all.size() && all[i].ends == ends; ++i) balance += all[i].direction;
        chain.insert(chain.end(), static_cast<std::size_t>(std::abs(balance)), balance > 0 ? ends : Edge{ends[1], ends[0]});
    }
    return chain;
}

Matrix4 assembled(const Matrix3& second, const Vector3& first, double zeroth) {
    Matrix4 moments;
    moments << second, first, first.transpose(), zeroth;
    return moments;
}

}  // namespace

Matrix4 solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    const TetrahedronSums sums = tetrahedron_sums(vertices, triangles);
    return assembled(sums.second / 120, sums.first / 24, sums.zeroth / 6);
}

Matrix4 surface_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    // Triangle of area A: int x = A/3 S, int x x^T = A/12 (a a^T + b b^T + c c^T + S S^T).
    Matrix3 second = Matrix3::Zero();
    Vector3 first = Vector3::Zero();
    double zeroth = 0;
    for (const Triangle& triangle : triangles) {
        const Vector3 a = vertices.col(triangle[0]), b = vertices.col(triangle[1]), c = vertices.col(triangle[2]);
        const double area = (b - a).cross(c - a).norm() / 2;
        const CornerSums sums = corner_sums(a, b, c);
        second += area * sums.second;
        first += area * sums.first;
        zeroth += area;
    }
    return assembled(second / 12, first / 3, zeroth);
}

Matrix4 line_moments(const Matrix3X& vertices, const std::vector<Edge>& edges) {
    // Segment of length L: int x = L/2 (a + b), int x x^T = L/6 (a a^T + b b^T + (a + b)(a + b)^T).
    Matrix3 second = Matrix3::Zero();
    Vector3 first = Vector3::Zero();
    double zeroth = 0;
    for (const Edge& edge : edges) {
        const Vector3 a = vertices.col(edge[0]), b = vertices.col(edge[1]), sum = a + b;
        const double length = (b - a).norm();
        second += length * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
        first += length * sum;
        zeroth += length;
    }
    return assembled(second / 6, first / 2, zeroth);
}

Matrix4 point_moments(const Matrix3X& vertices) {
    return assembled(vertices * vertices.transpose(), vertices.rowwise().sum(), static_cast<double>(vertices.cols()));
}

std::vector<Opening> openings(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    const std::vector<Edge> chain = boundary_chain(triangles);
    if (chain.empty()) return {};
    std::vector<int> parent(static_cast<std::size_t>(vertices.cols()));
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[static_cast<std::size_t>(v)] != v)
            v = parent[static_cast<std::size_t>(v)] = parent[parent[static_cast<std::size_t>(v)]];
        return v;
    };
    for (const Edge& edge : chain) parent[static_cast<std::size_t>(root(edge[0]))] = root(edge[1]);
    std::map<int, Opening> parts;
    for (const Edge& edge : chain) parts[root(edge[0])].edges.push_back(edge);
    std::vector<Opening> result;
    for (auto& [representative, part] : parts) {
        const Vector3 origin = vertices.col(representative);
        for (const Edge& edge : part.edges) {
            const Vector3 a = vertices.col(edge[0]) - origin, b = vertices.col(edge[1]) - origin;
            part.area += 0.5 * a.cross(b);
            part.centre += 0.5 * (a + b) / static_cast<double>(part.edges.size());
        }
        part.centre += origin;
        result.push_back(std::move(part));
    }
    return result;
}

bool is_nearly_closed(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    const std::vector<Opening> found = openings(vertices, triangles);
    if (found.empty() || triangles.empty()) return !triangles.empty();
    double open = 0;
    for (const Opening& opening : found) open += opening.area.norm();
    return open <= 0.1 * surface_moments(vertices, triangles)(3, 3);
}

Matrix4 capped_solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    TetrahedronSums sums = tetrahedron_sums(vertices, triangles);
    for (const Opening& opening : openings(vertices, triangles)) {
        for (const Edge& edge : opening.edges) sums.add(vertices.col(edge[1]), vertices.col(edge[0]), opening.centre);
    }
    return assembled(sums.second / 120, sums.first / 24, sums.zeroth / 6);
}

Matrix4 shifted_moments(const Matrix4& moments, const Vector3& shift) {
    // [X - s; 1] = T [X; 1], so M' = T M T^T.
    Matrix4 translation = Matrix4::Identity();
    translation.topRightCorner<3, 1>() = -shift;
    return translation * moments * translation.transpose();
}

}  // namespace fettle::core::geometry
