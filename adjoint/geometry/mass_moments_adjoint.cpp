// SPDX-License-Identifier: MIT
#include "adjoint/geometry/mass_moments_adjoint.hpp"

#include <Eigen/Geometry>
#include <array>

#include "core/base/contract.hpp"

namespace fettle::adjoint::geometry {
namespace {

using core::geometry::Edge;
using core::geometry::Opening;
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

// The solid as its caps close it: the openings' centres are vertices behind the mesh's own.
struct CappedMesh {
    std::vector<Triangle> triangles;
    Eigen::Index own = 0;  // vertices
    const std::vector<Opening>& openings;

    CappedMesh(Eigen::Index vertices, const std::vector<Triangle>& surface, const std::vector<Opening>& found)
        : triangles(surface), own(vertices), openings(found) {
        for (std::size_t k = 0; k < openings.size(); ++k)
            for (const Edge& edge : openings[k].edges) triangles.push_back({edge[1], edge[0], static_cast<int>(own) + static_cast<int>(k)});
    }

    // The vertices with the openings' centres: coordinates, or their changes.
    Matrix3X with_centres(const Matrix3X& vertices) const {
        Matrix3X out(3, own + static_cast<Eigen::Index>(openings.size()));
        out.leftCols(own) = vertices;
        for (std::size_t k = 0; k < openings.size(); ++k) {
            Vector3 sum = Vector3::Zero();
            for (const Edge& edge : openings[k].edges) sum += vertices.col(edge[0]) + vertices.col(edge[1]);
            out.col(own + static_cast<Eigen::Index>(k)) = sum / (2 * static_cast<double>(openings[k].edges.size()));
        }
        return out;
    }

    void add_without_centres(const Matrix3X& bar, Matrix3X& vertices_bar) const {
        vertices_bar += bar.leftCols(own);
        for (std::size_t k = 0; k < openings.size(); ++k) {
            const Vector3 share = bar.col(own + static_cast<Eigen::Index>(k)) / (2 * static_cast<double>(openings[k].edges.size()));
            for (const Edge& edge : openings[k].edges) {
                vertices_bar.col(edge[0]) += share;
                vertices_bar.col(edge[1]) += share;
            }
        }
    }
};

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

void capped_solid_moments_adjoint(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& openings,
                                  const Matrix4& moments_bar, Matrix3X& vertices_bar) {
    if (openings.empty()) return solid_moments_adjoint(vertices, triangles, moments_bar, vertices_bar);
    const CappedMesh capped(vertices.cols(), triangles, openings);
    const Matrix3X all = capped.with_centres(vertices);
    Matrix3X bar = Matrix3X::Zero(3, all.cols());
    solid_moments_adjoint(all, capped.triangles, moments_bar, bar);
    capped.add_without_centres(bar, vertices_bar);
}

Matrix4 capped_solid_moments_tangent(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& openings,
                                     const Matrix3X& vertices_dot) {
    if (openings.empty()) return solid_moments_tangent(vertices, triangles, vertices_dot);
    const CappedMesh capped(vertices.cols(), triangles, openings);
    return solid_moments_tangent(capped.with_centres(vertices), capped.triangles, capped.with_centres(vertices_dot));
}

void line_moments_adjoint(const Matrix3X& vertices, const std::vector<Edge>& edges, const Matrix4& moments_bar, Matrix3X& vertices_bar) {
    const Matrix4 symmetric = (moments_bar + moments_bar.transpose()) / 2;
    const Matrix3 second_bar = symmetric.topLeftCorner<3, 3>() / 6;
    const Vector3 first_bar = symmetric.topRightCorner<3, 1>();
    for (const Edge& edge : edges) {
        const Vector3 a = vertices.col(edge[0]), b = vertices.col(edge[1]), sum = a + b;
        const double length = (b - a).norm();
        if (length == 0) continue;
        const Vector3 along = (b - a) / length, sum_bar = second_bar * sum;
        const double density = a.dot(second_bar * a) + b.dot(second_bar * b) + sum.dot(sum_bar) + first_bar.dot(sum) + symmetric(3, 3);
        vertices_bar.col(edge[0]) += length * (2 * (second_bar * a + sum_bar) + first_bar) - density * along;
        vertices_bar.col(edge[1]) += length * (2 * (second_bar * b + sum_bar) + first_bar) + density * along;
    }
}

Matrix4 line_moments_tangent(const Matrix3X& vertices, const std::vector<Edge>& edges, const Matrix3X& vertices_dot) {
    Matrix4 out = Matrix4::Zero();
    for (const Edge& edge : edges) {
        const Vector3 a = vertices.col(edge[0]), b = vertices.col(edge[1]), sum = a + b;
        const Vector3 a_dot = vertices_dot.col(edge[0]), b_dot = vertices_dot.col(edge[1]), sum_dot = a_dot + b_dot;
        const double length = (b - a).norm();
        if (length == 0) continue;
        const double length_dot = (b - a).dot(b_dot - a_dot) / length;
        const Matrix3 second = a * a.transpose() + b * b.transpose() + sum * sum.transpose();
        const Matrix3 half_dot = a_dot * a.transpose() + b_dot * b.transpose() + sum_dot * sum.transpose();
        const Vector3 first_dot = 0.5 * (length_dot * sum + length * sum_dot);
        out.topLeftCorner<3, 3>() += (length_dot * second + length * (half_dot + half_dot.transpose())) / 6;
        out.topRightCorner<3, 1>() += first_dot;
        out.bottomLeftCorner<1, 3>() += first_dot.transpose();
        out(3, 3) += length_dot;
    }
    return out;
}

void point_moments_adjoint(const Matrix3X& vertices, const Matrix4& moments_bar, Matrix3X& vertices_bar) {
    const Matrix4 symmetric = moments_bar + moments_bar.transpose();
    vertices_bar += symmetric.topLeftCorner<3, 3>() * vertices;
    vertices_bar.colwise() += Vector3(symmetric.topRightCorner<3, 1>());
}

Matrix4 point_moments_tangent(const Matrix3X& vertices, const Matrix3X& vertices_dot) {
    const Matrix3 half = vertices_dot * vertices.transpose();
    const Vector3 first = vertices_dot.rowwise().sum();
    Matrix4 out;
    out << half + half.transpose(), first, first.transpose(), 0;
    return out;
}

Matrix4 shifted_moments_adjoint(const Matrix4& shifted_bar, const Vector3& shift) {
    Matrix4 translation = Matrix4::Identity();
    translation.topRightCorner<3, 1>() = -shift;
    return translation.transpose() * shifted_bar * translation;
}

}  // namespace fettle::adjoint::geometry
