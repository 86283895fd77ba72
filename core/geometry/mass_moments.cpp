// SPDX-License-Identifier: MIT
#include "core/geometry/mass_moments.hpp"

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
    CornerSums sums;
    sums.first = a + b + c;
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
            sums.second(i, j) = sums.second(j, i) = a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sums.first[i] * sums.first[j];
    return sums;
}

/// Moments of the tetrahedron (0, a, b, c), V = det(a, b, c) / 6: int x = V/4 S, int x x^T = V/20 (a a^T + b b^T + c c^T + S S^T).
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
std::vector<Edge> boundary_chain(const std::vector<HalfEdge>& halves) {
    std::vector<Edge> chain;
    visit_edges(halves, [&](std::size_t first, std::size_t last) {
        const int low = halves[first].low, high = halves[first].high;
        if (low == high) return;
        int balance = 0;
        for (std::size_t i = first; i < last; ++i) balance += halves[i].forward ? 1 : -1;
        if (balance != 0)
            chain.insert(chain.end(), static_cast<std::size_t>(std::abs(balance)), balance > 0 ? Edge{low, high} : Edge{high, low});
    });
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
    return openings(vertices, sorted_half_edges(triangles));
}

std::vector<Opening> openings(const Matrix3X& vertices, const std::vector<HalfEdge>& halves) {
    const std::vector<Edge> chain = boundary_chain(halves);
    if (chain.empty()) return {};
    std::vector<int> parent(vertices.cols());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Edge& edge : chain) parent[root(edge[0])] = root(edge[1]);
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
    return is_nearly_closed(vertices, triangles, openings(vertices, triangles));
}

bool is_nearly_closed(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& found) {
    if (found.empty() || triangles.empty()) return !triangles.empty();
    double open = 0;
    for (const Opening& opening : found) open += opening.area.norm();
    return open <= 0.1 * surface_moments(vertices, triangles)(3, 3);
}

Matrix4 capped_solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    return capped_solid_moments(vertices, triangles, openings(vertices, triangles));
}

Matrix4 capped_solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& found) {
    TetrahedronSums sums = tetrahedron_sums(vertices, triangles);
    for (const Opening& opening : found) {
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
