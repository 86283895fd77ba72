// SPDX-License-Identifier: MIT
/// Moments of bodies (core/model/body_mass.hpp) in their vertices and density, reverse and forward:
///   M = density U(X) + 1/2 max(lacking, 0) diag(1, 1, 1, 0),   lacking = 1e-8 m r^2 - (s_1 + s_2)
/// with U the moments of density 1 by the body's MassKind, and of wires and points s_1 <= s_2 the smaller eigenvalues of the central second
/// moments C, whose sum changes by tr(dC) - u . dC u, u of the largest; r is |X| of the vertex farthest away (of several the first).
/// A given mass depends on neither.
#pragma once

#include "adjoint/model_gradient.hpp"
#include "core/base/result.hpp"

namespace fettle::adjoint::model {

/// The body's moments are those of its mesh, density and MassKind, to 1e-9: not from elsewhere.
bool has_moments_of_mesh(const core::model::Body& body, double dhat);

/// Bodies that move freely whose moments are none of their mesh and density (unsupported).
Errors check_masses(const core::model::Model& model);

/// Adds to the body's vertices_bar and density_bar. Contract: has_moments_of_mesh, or its mass is given, or `moments_bar` is zero.
void mass_moments_adjoint(const core::model::Body& body, double dhat, const Matrix4& moments_bar, BodyGradient& bar);

/// Change of the moments along the body's vertices_dot and density_dot; zero where the mass is given, or the moments are from elsewhere.
Matrix4 mass_moments_tangent(const core::model::Body& body, double dhat, const BodyTangent& dot);

}  // namespace fettle::adjoint::model
