// SPDX-License-Identifier: MIT
/// Derivative of a body's mass in its vertices, by what its density is per (core/scene/mass_kind.hpp). The amount that the density counts
/// is
///   amount = unit_moments(mesh, kind)(3, 3):   volume [m^3], area [m^2], length of the edges [m], number of vertices [1]
/// and mass = density * amount.
#pragma once

#include "core/scene/mass_kind.hpp"

namespace fettle::adjoint::scene {

/// vertices_bar += amount_bar * d(amount)/d(vertices).
///   volume   per tetrahedron (0, a, b, c): d/da = (b x c)/6 and cyclic; openings are capped by the fan to their centre, which moves with
///            the openings' edges
///   area     as surface_moments_adjoint; a triangle of exactly zero area, where area has no derivative, contributes 0
///   length   d|b - a|/db = (b - a)/|b - a|; an edge of exactly zero length contributes 0
///   vertex   0
/// @param vertices_bar  3 x n like the mesh's vertices, added into.
void amount_adjoint(const core::geometry::Mesh& mesh, core::scene::MassKind kind, double amount_bar, Matrix3X& vertices_bar);

/// The same of all of unit_moments(mesh, kind): vertices_bar += (dM/dX)^T moments_bar, and M's change along vertices_dot
/// (geometry/mass_moments_adjoint.hpp).
void unit_moments_adjoint(const core::geometry::Mesh& mesh, core::scene::MassKind kind, const Matrix4& moments_bar, Matrix3X& vertices_bar);
Matrix4 unit_moments_tangent(const core::geometry::Mesh& mesh, core::scene::MassKind kind, const Matrix3X& vertices_dot);

}  // namespace fettle::adjoint::scene
