// SPDX-License-Identifier: MIT
#include "core/model/body_geometry.hpp"

#include <cmath>
#include <limits>
#include <memory>

#include "core/base/parallel.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/half_edges.hpp"

namespace fettle::core::model {
namespace {

double rounded_up_radius(const Matrix3X& vertices) {
    const double radius = std::sqrt(vertices.colwise().squaredNorm().maxCoeff());
    return radius * (1 + 8 * std::numeric_limits<double>::epsilon());  // three products, two sums, a root: below 4 units of rounding
}

void add_areas(Body& body) {
    const geometry::Mesh& mesh = body.mesh;
    body.vertex_area.assign(mesh.vertices.cols(), 0);
    body.edge_area.assign(mesh.edges.size(), 0);
    const geometry::EdgeIndex edge_index(mesh.edges);
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vector3 u = mesh.vertices.col(t[1]) - mesh.vertices.col(t[0]), v = mesh.vertices.col(t[2]) - mesh.vertices.col(t[0]);
        const double third = u.cross(v).norm() / 6;
        for (int k = 0; k < 3; ++k) {
            body.vertex_area[t[k]] += third;
            if (const int e = edge_index.find(t[k], t[(k + 1) % 3]); e >= 0) body.edge_area[e] += third;
        }
    }
}

}  // namespace

void complete_geometry(Body& body) {
    body.radius = rounded_up_radius(body.mesh.vertices);
    body.edge_length_squared.clear();
    body.edge_length_squared.reserve(body.mesh.edges.size());
    for (const auto& edge : body.mesh.edges) {
        body.edge_length_squared.push_back((body.mesh.vertices.col(edge[1]) - body.mesh.vertices.col(edge[0])).squaredNorm());
    }
    add_areas(body);
    constexpr double flatness = 1e-5;  // of the body: above single precision, and above what derivatives are checked with
    body.flat = std::make_shared<const geometry::FlatFeatures>(geometry::flat_features(body.mesh, flatness * body.radius));
    body.hierarchy = std::make_shared<const geometry::BodyHierarchy>(body.mesh, body.flat.get());
}

void complete_geometry(std::vector<Body>& bodies, const std::vector<std::size_t>& first_of_shape) {
    base::parallel_for(count_of(bodies), 1, [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        if (first_of_shape[at] == at) complete_geometry(bodies[at]);
    });
    base::parallel_for(count_of(bodies), 1, [&](int i) {
        const std::size_t first = first_of_shape[i];
        if (first == static_cast<std::size_t>(i)) return;
        Body& body = bodies[i];
        const Body& twin = bodies[first];
        body.radius = twin.radius;
        body.edge_length_squared = twin.edge_length_squared;
        body.vertex_area = twin.vertex_area;
        body.edge_area = twin.edge_area;
        body.hierarchy = twin.hierarchy;
        body.flat = twin.flat;
    });
}

void complete_geometry(std::vector<Body>& bodies) {
    std::vector<const geometry::Mesh*> meshes;
    meshes.reserve(bodies.size());
    for (const Body& body : bodies) meshes.push_back(&body.mesh);
    complete_geometry(bodies, geometry::first_of_shape(meshes));
}

geometry::Mesh mesh_at_start(const Body& body) {
    geometry::Mesh mesh = body.mesh;
    mesh.vertices = (body.pose_start.rotation * body.mesh.vertices).colwise() + body.pose_start.position;
    return mesh;
}

}  // namespace fettle::core::model
