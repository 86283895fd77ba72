// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/containment.hpp"

#include "fettle/core/geometry/mesh_validity.hpp"

namespace fettle::design::quantities {

namespace {

using core::geometry::Mesh;

// One vertex of everything that hangs together.
std::vector<int> samples(const Mesh& mesh) {
    std::vector<int> found = mesh.codimensional_points;
    std::vector<bool> seen(mesh.shell_names.size(), false), on_triangle(static_cast<size_t>(mesh.vertices.cols()), false);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const int v : mesh.triangles[t]) on_triangle[static_cast<size_t>(v)] = true;
        const auto shell = static_cast<size_t>(mesh.triangle_shell[t]);
        if (!seen[shell]) found.push_back(mesh.triangles[t][0]);
        seen[shell] = true;
    }
    for (const auto& edge : mesh.edges) {
        if (!on_triangle[static_cast<size_t>(edge[0])]) found.push_back(edge[0]);
    }
    return found;
}

bool lies_inside(const Mesh& inner, const Matrix3X& inner_vertices, const Mesh& outer, const Matrix3X& outer_vertices) {
    if (outer.triangles.empty()) return false;
    const Vector3 low = outer_vertices.rowwise().minCoeff(), high = outer_vertices.rowwise().maxCoeff();
    bool closed = false;  // worth finding out only when something lies within the box
    for (const int v : samples(inner)) {
        const Vector3 point = inner_vertices.col(v);
        if ((point.array() < low.array()).any() || (point.array() > high.array()).any()) continue;
        if (!closed && !core::geometry::is_closed(outer)) return false;
        closed = true;
        if (core::geometry::point_in_solid(point, outer_vertices, outer.triangles)) return true;
    }
    return false;
}

}  // namespace

std::string containment(const core::model::Model& model, const std::vector<core::kinematics::Pose>& poses, int a, int b) {
    const auto body = [&](int index) -> const core::model::Body& { return model.bodies[static_cast<size_t>(index)]; };
    const auto placed = [&](int index) -> Matrix3X {
        const core::kinematics::Pose& pose = poses[static_cast<size_t>(index)];
        return (pose.rotation * body(index).mesh.vertices).colwise() + pose.position;
    };
    const Matrix3X at_a = placed(a), at_b = placed(b);
    const auto told = [&](int inner, int outer) {
        return "`" + body(inner).name + "` lies inside the material of `" + body(outer).name + "`";
    };
    if (lies_inside(body(a).mesh, at_a, body(b).mesh, at_b)) return told(a, b);
    if (lies_inside(body(b).mesh, at_b, body(a).mesh, at_a)) return told(b, a);
    return {};
}

}  // namespace fettle::design::quantities
