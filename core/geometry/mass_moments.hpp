// SPDX-License-Identifier: MIT
/// The 4x4 moment matrix of a solid, a surface, wires or points, M = integral of rho [X;1][X;1]^T, exactly (consistent, never lumped).
/// Derivative of the solid's: adjoint/geometry/mass_moments_adjoint.hpp.
#pragma once

#include <vector>

#include "core/geometry/half_edges.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::geometry {

/// Moments with unit density of the solid bounded by a closed, outward oriented mesh (divergence theorem: signed tetrahedra to the origin).
///   M(0:3,0:3) second moments [m^5], M(0:3,3) first moments [m^4], M(3,3) volume [m^3]. Negative volume: the mesh is inside out.
Matrix4 solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// Moments with unit area density of the triangles as a shell (consistent, not lumped). [m^4, m^3, m^2]
Matrix4 surface_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// Moments with unit line density of the edges as wires. [m^3, m^2, m]
Matrix4 line_moments(const Matrix3X& vertices, const std::vector<Edge>& edges);

/// Moments of unit masses at the vertices. [m^2, m, 1]
Matrix4 point_moments(const Matrix3X& vertices);

/// Where triangles do not close: each connected part of the boundary chain (edges less their reverses) is a closed loop or several that
/// touch. A crack whose sides coincide, such as a T-junction, encloses no area; a hole does.
struct Opening {
    std::vector<Edge> edges;           ///< directed as in the triangles, repeated where an edge misses several reverses
    Vector3 area = Vector3::Zero();    ///< area vector, 1/2 sum a x b [m^2]
    Vector3 centre = Vector3::Zero();  ///< mean of the edges' mid points
};
std::vector<Opening> openings(const Matrix3X& vertices, const std::vector<Triangle>& triangles);

/// The same of triangles whose half edges are known. Here and below: what one mesh is asked several times is worked out once.
std::vector<Opening> openings(const Matrix3X& vertices, const std::vector<HalfEdge>& halves);

/// Openings enclose at most a tenth of the surface: the solid that is meant is that with the openings capped. Closed meshes are; an open
/// box is not (a fifth), nor is a sheet. False without triangles.
bool is_nearly_closed(const Matrix3X& vertices, const std::vector<Triangle>& triangles);
bool is_nearly_closed(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& openings);

/// solid_moments with every opening capped by the fan to its centre, so that they do not depend on the origin (up to rounding, bit for bit
/// solid_moments if there is no opening).
Matrix4 capped_solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles);
Matrix4 capped_solid_moments(const Matrix3X& vertices, const std::vector<Triangle>& triangles, const std::vector<Opening>& openings);

/// M about another origin: moments of X - shift.
Matrix4 shifted_moments(const Matrix4& moments, const Vector3& shift);

}  // namespace fettle::core::geometry
