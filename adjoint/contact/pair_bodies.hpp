// SPDX-License-Identifier: MIT
/// A contact's four vertices, the bodies that they are on, and how those of round surfaces follow from the meshes' vertices.
#pragma once

#include <array>

#include "adjoint/model_gradient.hpp"
#include "core/contact/contact_set.hpp"
#include "core/geometry/rounded_sides.hpp"

namespace fettle::adjoint::contact {

/// One vector for each of a pair's vertices.
using Four = std::array<Vector3, 4>;

inline double dot(const Four& a, const Four& b) { return a[0].dot(b[0]) + a[1].dot(b[1]) + a[2].dot(b[2]) + a[3].dot(b[3]); }

/// The body of each vertex.
inline std::array<int, 4> bodies_of(const core::contact::BodyPairContacts& list, const core::contact::ContactPair& pair) {
    std::array<int, 4> body;
    for (int i = 0; i < 4; ++i) body[i] = i < first_count(pair.type) ? list.first : list.second;
    return body;
}

/// Each vertex in its own body's frame.
inline Four undeformed(const core::model::Model& model, const std::array<int, 4>& body, const core::contact::ContactPair& pair) {
    Four X;
    for (int i = 0; i < 4; ++i) X[i] = core::contact::undeformed_vertex(model.bodies[body[i]], pair.vertex[i]);
    return X;
}

/// The corner that a round vertex is the centre of: the mesh's vertices, and where they are.
struct CornerVertices {
    std::array<int, 3> vertex;
    std::array<Vector3, 3> x;
    CornerVertices(const core::model::Body& body, int centre) : vertex(body.round->vertices_of(body.round->places[centre])) {
        for (int k = 0; k < 3; ++k) x[k] = body.mesh.vertices.col(vertex[k]);
    }
};

inline void add_corner_gradient(const core::model::Body& body, int centre, const core::geometry::RoundedCorner& bar,
                                Matrix3X& vertices_bar) {
    const CornerVertices corner(body, centre);
    const auto x_bar = core::geometry::rounded_corner_adjoint(corner.x, bar);
    for (int k = 0; k < 3; ++k) vertices_bar.col(corner.vertex[k]) += x_bar[k];
}

inline core::geometry::RoundedCorner corner_tangent(const core::model::Body& body, int centre, const Matrix3X& vertices_dot) {
    const CornerVertices corner(body, centre);
    return core::geometry::rounded_corner_tangent(
        corner.x, {vertices_dot.col(corner.vertex[0]), vertices_dot.col(corner.vertex[1]), vertices_dot.col(corner.vertex[2])});
}

/// vertices_bar += of a contact's vertex, in the body's frame.
inline void add_vertex_gradient(const core::model::Body& body, int vertex, const Vector3& bar, Matrix3X& vertices_bar) {
    if (vertex >= 0)
        vertices_bar.col(vertex) += bar;
    else
        add_corner_gradient(body, -1 - vertex, {bar, 0, 0}, vertices_bar);
}

inline Vector3 vertex_tangent(const core::model::Body& body, int vertex, const Matrix3X& vertices_dot) {
    return vertex >= 0 ? Vector3(vertices_dot.col(vertex)) : corner_tangent(body, -1 - vertex, vertices_dot).centre;
}

/// Adds the gradient of a round contact's reach[k], k = 0 for the first body.
inline void add_reach_gradient(const core::model::Body& body, const core::contact::RoundGap& round, std::size_t k, double bar,
                               Matrix3X& vertices_bar) {
    if (round.centre[k] >= 0) add_corner_gradient(body, round.centre[k], {Vector3::Zero(), round.sign[k] * bar, 0}, vertices_bar);
    if (round.cover[k] >= 0) add_corner_gradient(body, round.cover[k], {Vector3::Zero(), 0, round.side * bar}, vertices_bar);
}

inline double reach_tangent(const core::model::Body& body, const core::contact::RoundGap& round, std::size_t k,
                            const Matrix3X& vertices_dot) {
    double dot = 0;
    if (round.centre[k] >= 0) dot += round.sign[k] * corner_tangent(body, round.centre[k], vertices_dot).radius;
    if (round.cover[k] >= 0) dot += round.side * corner_tangent(body, round.cover[k], vertices_dot).height;
    return dot;
}

}  // namespace fettle::adjoint::contact
