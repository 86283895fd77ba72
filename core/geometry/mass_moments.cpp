// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/mass_moments.hpp"

#include <Eigen/Geometry>

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

Matrix4 assembled(const Matrix3& second, const Vector3& first, double zeroth) {
    Matrix4 moments;
    moments << second, first, first.transpose(), zeroth;
    return moments;
}

}  // namespace

Matrix4 solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles) {
    // Tetrahedron (0, a, b, c), V = det(a, b, c) / 6: int x = V/4 S, int x x^T = V/20 (a a^T + b b^T + c c^T + S S^T).
    Matrix3 second = Matrix3::Zero();
    Vector3 first = Vector3::Zero();
    double zeroth = 0;
    for (const Triangle& triangle : triangles) {
        const Vector3 a = vertices.col(triangle[0]), b = vertices.col(triangle[1]), c = vertices.col(triangle[2]);
        const double determinant = a.dot(b.cross(c));
        const CornerSums sums = corner_sums(a, b, c);
        second += determinant * sums.second;
        first += determinant * sums.first;
        zeroth += determinant;
    }
    return assembled(second / 120, first / 24, zeroth / 6);
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

Matrix4 shifted_moments(const Matrix4& moments, const Vector3& shift) {
    // [X - s; 1] = T [X; 1], so M' = T M T^T.
    Matrix4 translation = Matrix4::Identity();
    translation.topRightCorner<3, 1>() = -shift;
    return translation * moments * translation.transpose();
}

}  // namespace fettle::core::geometry
