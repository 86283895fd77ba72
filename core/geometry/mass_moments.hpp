// SPDX-License-Identifier: MIT
/// The 4x4 moment matrix of a solid or a surface, M = integral of rho [X;1][X;1]^T, exactly, as polynomials in the vertices.
/// Its derivative: adjoint/geometry/mass_moments_adjoint.hpp.
#pragma once

#include "fettle/core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Moments with unit density of the solid bounded by a closed, outward oriented mesh (divergence theorem: signed tetrahedra to the origin).
///   M(0:3,0:3) second moments [m^5], M(0:3,3) first moments [m^4], M(3,3) volume [m^3]. Negative volume: the mesh is inside out.
Matrix4 solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// Moments with unit area density of the triangles as a shell (consistent, not lumped). [m^4, m^3, m^2]
Matrix4 surface_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// M about another origin: moments of X - shift.
Matrix4 shifted_moments(const Matrix4& moments, const Vector3& shift);

}  // namespace fettle::core::geometry
