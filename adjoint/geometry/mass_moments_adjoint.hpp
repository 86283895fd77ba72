// SPDX-License-Identifier: MIT
/// Derivatives of the moment matrices of core/geometry/mass_moments.hpp in the vertex coordinates, exact: the moments are polynomials
/// (solid) or polynomials times areas (surface). `_adjoint` is the reverse map M_bar -> X_bar, `_tangent` the forward map X_dot -> M_dot;
/// <M_bar, tangent(X_dot)> = <adjoint(M_bar), X_dot> with <A, B> = sum_ij A_ij B_ij.
///
/// Accuracy: terms of size |X|^5 cancel for a part far from the origin, in the moments and here. Shift the vertices to the body's
/// reference point c first (docs/method/bodies.md#mass; the derivative in X - c is the derivative in X, as c is fixed).
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/geometry/mass_moments.hpp"

namespace fettle::adjoint::geometry {

/// vertices_bar += (dM/dX)^T moments_bar for M = solid_moments(vertices, triangles).
/// Per tetrahedron (0, a, b, c): L = det(a, b, c) f with f = (a'Aa + b'Ab + c'Ac + S'AS)/120 + g.S/12 + w/6, S = a + b + c, and
///   dL/da = f (b x c) + det ((A a + A S)/60 + g/12), likewise for b and c by cyclic exchange;
/// [A g; g' w] is the symmetric part of moments_bar (which itself may be unsymmetric).
/// @param vertices_bar  3 x n like `vertices`, added into.
void solid_moments_adjoint(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles, const Matrix4& moments_bar,
                           Matrix3X& vertices_bar);

/// Derivative of solid_moments along vertices_dot (3 x n). Symmetric.
Matrix4 solid_moments_tangent(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles,
                              const Matrix3X& vertices_dot);

/// vertices_bar += (dM/dX)^T moments_bar for M = surface_moments(vertices, triangles).
/// Per triangle: L = area f, f = (a'Aa + b'Ab + c'Ac + S'AS)/12 + 2 g.S/3 + w; d(area)/da = ((b - c) x n)/2 with the unit normal n.
/// A triangle of exactly zero area, where area has no derivative, contributes 0 (validate_mesh refuses such triangles).
void surface_moments_adjoint(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles, const Matrix4& moments_bar,
                             Matrix3X& vertices_bar);

/// Derivative of surface_moments along vertices_dot (3 x n). Symmetric. Zero-area triangles as above.
Matrix4 surface_moments_tangent(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles,
                                const Matrix3X& vertices_dot);

/// The same of capped_solid_moments: each opening's fan of tetrahedra (0, e1, e0, centre), whose centre moves with the opening's edges.
/// @param openings  openings(vertices, triangles)
void capped_solid_moments_adjoint(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles,
                                  const std::vector<core::geometry::Opening>& openings, const Matrix4& moments_bar, Matrix3X& vertices_bar);
Matrix4 capped_solid_moments_tangent(const Matrix3X& vertices, const std::vector<core::geometry::Triangle>& triangles,
                                     const std::vector<core::geometry::Opening>& openings, const Matrix3X& vertices_dot);

/// The adjoint of line_moments: per edge L = |b - a| f, f = (a'Aa + b'Ab + S'AS)/6 + g.S + w, S = a + b. An edge of exactly zero length
/// contributes 0.
void line_moments_adjoint(const Matrix3X& vertices, const std::vector<core::geometry::Edge>& edges, const Matrix4& moments_bar,
                          Matrix3X& vertices_bar);
Matrix4 line_moments_tangent(const Matrix3X& vertices, const std::vector<core::geometry::Edge>& edges, const Matrix3X& vertices_dot);

/// The adjoint of point_moments: per vertex x'Ax + 2 g.x + w.
void point_moments_adjoint(const Matrix3X& vertices, const Matrix4& moments_bar, Matrix3X& vertices_bar);
Matrix4 point_moments_tangent(const Matrix3X& vertices, const Matrix3X& vertices_dot);

/// Reverse map of shifted_moments in its moments (the shift is a constant): M' = T M T^T, so M_bar = T^T M'_bar T. The forward map is
/// shifted_moments itself, as it is linear.
Matrix4 shifted_moments_adjoint(const Matrix4& shifted_bar, const Vector3& shift);

}  // namespace fettle::adjoint::geometry
