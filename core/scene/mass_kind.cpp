// SPDX-License-Identifier: MIT
#include "core/scene/mass_kind.hpp"

#include <cmath>

#include "core/geometry/mass_moments.hpp"

namespace fettle::core::scene {

Matrix4 unit_moments(const geometry::Mesh& mesh, MassKind kind) {
    switch (kind) {
        case MassKind::volume:
            return geometry::capped_solid_moments(mesh.vertices, mesh.triangles);
        case MassKind::area:
            return geometry::surface_moments(mesh.vertices, mesh.triangles);
        case MassKind::length:
            return geometry::line_moments(mesh.vertices, mesh.edges);
        case MassKind::vertex:
            break;
    }
    return geometry::point_moments(mesh.vertices);
}

std::optional<Vector3> centre_of_mass(const geometry::Mesh& mesh, MassKind kind) {
    if (kind != MassKind::volume) return centre_of_mass(unit_moments(mesh, kind));
    const std::vector<geometry::Opening> openings = geometry::openings(mesh.vertices, mesh.triangles);
    if (!geometry::is_nearly_closed(mesh.vertices, mesh.triangles, openings)) return std::nullopt;
    return centre_of_mass(geometry::capped_solid_moments(mesh.vertices, mesh.triangles, openings));
}

std::optional<Vector3> centre_of_mass(const Matrix4& moments) {
    const Vector3 centre = moments.col(3).head<3>() / moments(3, 3);
    if (!(std::abs(moments(3, 3)) > 0) || !centre.allFinite()) return std::nullopt;
    return centre;
}

const char* density_unit(MassKind kind) {
    switch (kind) {
        case MassKind::volume:
            return "kg/m^3";
        case MassKind::area:
            return "kg/m^2";
        case MassKind::length:
            return "kg/m";
        case MassKind::vertex:
            break;
    }
    return "kg";
}

}  // namespace fettle::core::scene
