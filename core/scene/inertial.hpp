// SPDX-License-Identifier: MIT
/// Mass and inertia of a body that are given, not counted from its mesh: of a part that is not of one material, or of a machine's data
/// sheet.
#pragma once

#include <string>

#include "core/base/types.hpp"

namespace fettle::core::scene {

struct Inertial {
    double mass = 0;                    ///< [kg]
    Vector3 centre = Vector3::Zero();   ///< of mass, in the mesh file's frame [m]
    Matrix3 inertia = Matrix3::Zero();  ///< J about the centre, axes of the mesh file's frame [kg m^2]
};

/// Why no body has this, for a message; empty: one may. A body's mass is above 0, its J symmetric and positive definite, and no principal
/// moment is more than the sum of the other two; equal, it is flat. To 1e-6 of J's trace, for files round.
std::string fault_of(const Inertial& inertial);

/// Second moments M = integral of rho [X;1][X;1]^T about a point c of the file's frame, X = x - c:
///   M = [S + m r r^T, m r; m r^T, m],   S = tr(J)/2 1 - J,   r = centre - c
/// S without what is negative of it by rounding. Contract: fault_of is empty.
Matrix4 moments_about(const Inertial& inertial, const Vector3& c);

/// The same backwards, of moments about the file's origin. Contract: M(3, 3) > 0.
Inertial inertial_of(const Matrix4& moments);

}  // namespace fettle::core::scene
