// SPDX-License-Identifier: MIT
#include "adjoint/scene/mass_kind_adjoint.hpp"

#include <Eigen/Geometry>

#include "adjoint/geometry/mass_moments_adjoint.hpp"
#include "core/base/contract.hpp"
#include "core/geometry/mass_moments.hpp"

namespace fettle::adjoint::scene {
namespace {

using core::geometry::Edge;
using core::geometry::Mesh;
using core::geometry::Opening;
using core::scene::MassKind;

Matrix4 zeroth_moment_bar(double bar) {
    Matrix4 moments_bar = Matrix4::Zero();
    moments_bar(3, 3) = bar;
    return moments_bar;
}

// The caps' tetrahedra (0, e1, e0, centre); the centre is the mean of the edges' mid points.
void add_caps(const Mesh& mesh, double bar, Matrix3X& vertices_bar) {
    for (const Opening& opening : core::geometry::openings(mesh.vertices, mesh.triangles)) {
        Vector3 centre_bar = Vector3::Zero();
        for (const Edge& edge : opening.edges) {
            const Vector3 a = mesh.vertices.col(edge[1]), b = mesh.vertices.col(edge[0]);
            vertices_bar.col(edge[1]) += bar / 6 * b.cross(opening.centre);
            vertices_bar.col(edge[0]) += bar / 6 * opening.centre.cross(a);
            centre_bar += bar / 6 * a.cross(b);
        }
        const Vector3 share = centre_bar / (2 * static_cast<double>(opening.edges.size()));
        for (const Edge& edge : opening.edges) {
            vertices_bar.col(edge[0]) += share;
            vertices_bar.col(edge[1]) += share;
        }
    }
}

void add_lengths(const Mesh& mesh, double bar, Matrix3X& vertices_bar) {
    for (const Edge& edge : mesh.edges) {
        const Vector3 along = mesh.vertices.col(edge[1]) - mesh.vertices.col(edge[0]);
        const double length = along.norm();
        if (length == 0) continue;
        vertices_bar.col(edge[1]) += bar / length * along;
        vertices_bar.col(edge[0]) -= bar / length * along;
    }
}

}  // namespace

void amount_adjoint(const Mesh& mesh, MassKind kind, double bar, Matrix3X& vertices_bar) {
    FETTLE_ASSERT(vertices_bar.cols() == mesh.vertices.cols(), "vertices_bar has one column per vertex");
    switch (kind) {
        case MassKind::volume:
            geometry::solid_moments_adjoint(mesh.vertices, mesh.triangles, zeroth_moment_bar(bar), vertices_bar);
            add_caps(mesh, bar, vertices_bar);
            break;
        case MassKind::area:
            geometry::surface_moments_adjoint(mesh.vertices, mesh.triangles, zeroth_moment_bar(bar), vertices_bar);
            break;
        case MassKind::length:
            add_lengths(mesh, bar, vertices_bar);
            break;
        case MassKind::vertex:
            break;
    }
}

void unit_moments_adjoint(const Mesh& mesh, MassKind kind, const Matrix4& moments_bar, Matrix3X& vertices_bar) {
    switch (kind) {
        case MassKind::volume:
            return geometry::capped_solid_moments_adjoint(
                mesh.vertices, mesh.triangles, core::geometry::openings(mesh.vertices, mesh.triangles), moments_bar, vertices_bar);
        case MassKind::area:
            return geometry::surface_moments_adjoint(mesh.vertices, mesh.triangles, moments_bar, vertices_bar);
        case MassKind::length:
            return geometry::line_moments_adjoint(mesh.vertices, mesh.edges, moments_bar, vertices_bar);
        case MassKind::vertex:
            return geometry::point_moments_adjoint(mesh.vertices, moments_bar, vertices_bar);
    }
}

Matrix4 unit_moments_tangent(const Mesh& mesh, MassKind kind, const Matrix3X& vertices_dot) {
    switch (kind) {
        case MassKind::volume:
            return geometry::capped_solid_moments_tangent(mesh.vertices, mesh.triangles,
                                                          core::geometry::openings(mesh.vertices, mesh.triangles), vertices_dot);
        case MassKind::area:
            return geometry::surface_moments_tangent(mesh.vertices, mesh.triangles, vertices_dot);
        case MassKind::length:
            return geometry::line_moments_tangent(mesh.vertices, mesh.edges, vertices_dot);
        case MassKind::vertex:
            break;
    }
    return geometry::point_moments_tangent(mesh.vertices, vertices_dot);
}

}  // namespace fettle::adjoint::scene
