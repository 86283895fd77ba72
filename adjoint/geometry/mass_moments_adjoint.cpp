// SPDX-License-Identifier: MIT
#include "fettle/adjoint/geometry/mass_moments_adjoint.hpp"

#include <Eigen/Geometry>
#include <array>

#include "fettle/core/base/contract.hpp"

namespace fettle::adjoint::geometry {
namespace {

using core::geometry::Triangle;

/// measure (6 V, or area) times corner polynomials: what solids and surfaces share. Factors of the second, first and zeroth moment.
struct Factors {
    double second, first, zeroth;
};
constexpr Factors solid_factors{1.0 / 120, 1.0 / 24, 1.0 / 6};
constexpr Factors surface_factors{1.0 / 12, 1.0 / 3, 1.0};

/// A triangle's measure and its derivative in each corner.
struct Measure {
    double value;
    std::array<Vector3, 3> gradient;
};

using Corners = std::array<Vector3, 3>;

Corners corners(const Matrix3X& x, const Triangle& t) { return {x.col(t[0]), x.col(t[1]), x.col(t[2])}; }

Measure solid_measure(const Corners& x) {
    const Vector3 bc = x[1].cross(x[2]);
    return {x[0].dot(bc), {bc, x[2].cross(x[0]), x[0].cross(x[1])}};
}

Measure surface_measure(const Corners& x) {
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    const double length = normal.norm();
    if (length == 0) return {0, {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()}};
    const Vector3 half_unit = normal / (2 * length);
    return {length / 2, {(x[1] - x[2]).cross(half_unit), (x[2] - x[0]).cross(half_unit), (x[0] - x[1]).cross(half_unit)}};
}

template <class MeasureOf>
void add_adjoint(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix4& moments_bar, const Factors& factors,
                 MeasureOf measure_of, Matrix3X& vertices_bar) {
    FETTLE_ASSERT(vertices_bar.cols() == vertices.cols(), "vertices_bar has one column per vertex");
    const Matrix4 symmetric = (moments_bar + moments_bar.transpose()) / 2;
    const Matrix3 second_bar = factors.second * symmetric.topLeftCorner<3, 3>();
    const Vector3 first_bar = 2 * factors.first * symmetric.topRightCorner<3, 1>();
    const double zeroth_bar = factors.zeroth * symmetric(3, 3);
    for (const Triangle& triangle : triangles) {
        const Corners x = corners(vertices, triangle);
        const Measure measure = measure_of(x);
        const Vector3 sum = x[0] + x[1] + x[2];
        const Vector3 sum_bar = second_bar * sum;
        double density = sum.dot(sum_bar) + first_bar.dot(sum) + zeroth_bar;
        for (const Vector3& corner : x) density += corner.dot(second_bar * corner);
        for (int k = 0; k < 3; ++k) {
            vertices_bar.col(triangle[k]) +=
                density * measure.gradient[k] + measure.value * (2 * (second_bar * x[k] + sum_bar) + first_bar);
        }
    }
}

template <class MeasureOf>
Matrix4 tangent(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix3X& vertices_dot, const Factors& factors,
                MeasureOf measure_of) {
    FETTLE_ASSERT(vertices_dot.cols() == vertices.cols(), "vertices_dot has one column per vertex");
    Matrix3 second_dot = Matrix3::Zero();
    Vector3 first_dot = Vector3::Zero();
    double zeroth_dot = 0;
    for (const Triangle& triangle : triangles) {
        const Corners x = corners(vertices, triangle), x_dot = corners(vertices_dot, triangle);
        const Measure measure = measure_of(x);
        const Vector3 sum = x[0] + x[1] + x[2], sum_dot = x_dot[0] + x_dot[1] + x_dot[2];
        double measure_dot = 0;
        Matrix3 value = sum * sum.transpose(), half_dot = sum * sum_dot.transpose();
        for (int k = 0; k < 3; ++k) {
            measure_dot += measure.gradient[k].dot(x_dot[k]);
            value += x[k] * x[k].transpose();
            half_dot += x[k] * x_dot[k].transpose();
        }
        second_dot += measure_dot * value + measure.value * (half_dot + half_dot.transpose());
        first_dot += measure_dot * sum + measure.value * sum_dot;
        zeroth_dot += measure_dot;
    }
    second_dot *= factors.second;
    first_dot *= factors.first;
    zeroth_dot *= factors.zeroth;
    Matrix4 moments_dot;
    moments_dot << second_dot, first_dot, first_dot.transpose(), zeroth_dot;
    return moments_dot;
}

}  // namespace

void solid_moments_adjoint(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix4& moments_bar,
                           Matrix3X& vertices_bar) {
    add_adjoint(vertices, triangles, moments_bar, solid_factors, solid_measure, vertices_bar);
}

Matrix4 solid_moments_tangent(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix3X& vertices_dot) {
    return tangent(vertices, triangles, vertices_dot, solid_factors, solid_measure);
}

void surface_moments_adjoint(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix4& moments_bar,
                             Matrix3X& vertices_bar) {
    add_adjoint(vertices, triangles, moments_bar, surface_factors, surface_measure, vertices_bar);
}

Matrix4 surface_moments_tangent(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const Matrix3X& vertices_dot) {
    return tangent(vertices, triangles, vertices_dot, surface_factors, surface_measure);
}

Matrix4 shifted_moments_adjoint(const Matrix4& shifted_bar, const Vector3& shift) {
    Matrix4 translation = Matrix4::Identity();
    translation.topRightCorner<3, 1>() = -shift;
    return translation.transpose() * shifted_bar * translation;
}

}  // namespace fettle::adjoint::geometry
