// SPDX-License-Identifier: MIT
#include "core/model/body_mass.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/mass_moments.hpp"
#include "core/linear/factorisations.hpp"

namespace fettle::core::model {
std::optional<Vector3> BodyMeasure::centre() const {
    if (!closed_enough) return std::nullopt;
    const Vector3 centre = unit_moments.col(3).head<3>() / unit_moments(3, 3);
    if (!(std::abs(unit_moments(3, 3)) > 0) || !centre.allFinite()) return std::nullopt;
    return centre;
}

BodyMeasure measure_body(const geometry::Mesh& mesh, scene::MassKind kind) {
    if (kind != scene::MassKind::volume) return {scene::unit_moments(mesh, kind), true};
    const std::vector<geometry::Opening> openings = geometry::openings(mesh.vertices, mesh.triangles);
    return {geometry::capped_solid_moments(mesh.vertices, mesh.triangles, openings),
            geometry::is_nearly_closed(mesh.vertices, mesh.triangles, openings)};
}

Vector3 default_reference_point(const scene::Body& body, const BodyMeasure& measure) {
    if (body.reference_point) return *body.reference_point;
    if (body.inertial) return body.inertial->centre;
    if (const auto centre = measure.centre()) return *centre;
    return 0.5 * (body.mesh.vertices.rowwise().minCoeff() + body.mesh.vertices.rowwise().maxCoeff());
}

Matrix4 mass_moments(const Body& body, double dhat) { return mass_moments(body, dhat, scene::unit_moments(body.mesh, body.mass_kind)); }

Matrix4 mass_moments(const Body& body, double dhat, const Matrix4& unit_moments) {
    Matrix4 moments = body.density * unit_moments;
    if (body.mass_kind != scene::MassKind::length && body.mass_kind != scene::MassKind::vertex) return moments;
    const double mass = moments(3, 3);
    const Vector3 first = moments.col(3).head<3>();
    const Matrix3 central = moments.topLeftCorner<3, 3>() - first * first.transpose() / mass;
    const Vector3 second = linear::symmetric_eigenvalues<3>(central);
    const double radius = std::max(body.radius, dhat);
    const double lacking = least_inertia * mass * radius * radius - (second[0] + second[1]);
    if (lacking > 0) moments.topLeftCorner<3, 3>().diagonal().array() += 0.5 * lacking;
    return moments;
}

}  // namespace fettle::core::model
