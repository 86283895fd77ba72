// SPDX-License-Identifier: MIT
#include "adjoint/contact/area_weights_adjoint.hpp"

#include <array>

#include "core/geometry/half_edges.hpp"

namespace fettle::adjoint::contact {
namespace {

using core::contact::AreaShare;
using core::geometry::Triangle;

// A triangle's area: its gradient in the corners.
std::array<Vector3, 3> area_gradient(const Matrix3X& vertices, const Triangle& t) {
    const Vector3 a = vertices.col(t[0]), b = vertices.col(t[1]), c = vertices.col(t[2]);
    const Vector3 normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (length == 0) return {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    const Vector3 half_unit = normal / (2 * length);
    return {(b - c).cross(half_unit), (c - a).cross(half_unit), (a - b).cross(half_unit)};
}

}  // namespace

AreaChange zero_areas(const core::model::Body& body) {
    return {VectorX::Zero(body.mesh.vertices.cols()), VectorX::Zero(body.mesh.edges.size())};
}

void areas_adjoint(const core::geometry::Mesh& mesh, const AreaChange& areas_bar, Matrix3X& vertices_bar) {
    const core::geometry::EdgeIndex edges(mesh.edges);
    for (const Triangle& t : mesh.triangles) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            sum += areas_bar.vertex[t[k]];
            if (const int e = edges.find(t[k], t[(k + 1) % 3]); e >= 0) sum += areas_bar.edge[e];
        }
        if (sum == 0) continue;
        const std::array<Vector3, 3> gradient = area_gradient(mesh.vertices, t);
        for (int k = 0; k < 3; ++k) vertices_bar.col(t[k]) += sum / 3 * gradient[k];
    }
}

AreaChange areas_tangent(const core::geometry::Mesh& mesh, const Matrix3X& vertices_dot) {
    const core::geometry::EdgeIndex edges(mesh.edges);
    AreaChange out{VectorX::Zero(mesh.vertices.cols()), VectorX::Zero(mesh.edges.size())};
    for (const Triangle& t : mesh.triangles) {
        const std::array<Vector3, 3> gradient = area_gradient(mesh.vertices, t);
        double third_dot = 0;
        for (int k = 0; k < 3; ++k) third_dot += gradient[k].dot(vertices_dot.col(t[k])) / 3;
        for (int k = 0; k < 3; ++k) {
            out.vertex[t[k]] += third_dot;
            if (const int e = edges.find(t[k], t[(k + 1) % 3]); e >= 0) out.edge[e] += third_dot;
        }
    }
    return out;
}

core::contact::ContactAreas areas_of_contacts(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses) {
    if (!model.area_weighted) return {};
    return core::contact::contact_areas(model, core::ccd::find_candidates(model, poses, 0), poses);
}

void add_weight_gradient(const std::vector<AreaShare>& shares, double weight_bar, std::vector<AreaChange>& areas_bar) {
    for (const AreaShare& share : shares) {
        AreaChange& of_body = areas_bar[share.body];
        (share.is_edge ? of_body.edge : of_body.vertex)[share.element] += share.factor * weight_bar;
    }
}

double weight_tangent(const std::vector<AreaShare>& shares, const std::vector<AreaChange>& areas_dot) {
    double sum = 0;
    for (const AreaShare& share : shares) {
        const AreaChange& of_body = areas_dot[share.body];
        sum += share.factor * (share.is_edge ? of_body.edge : of_body.vertex)[share.element];
    }
    return sum;
}

}  // namespace fettle::adjoint::contact
