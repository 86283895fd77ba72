// SPDX-License-Identifier: MIT
#include "core/geometry/mesh_transforms.hpp"

#include <algorithm>
#include <utility>

namespace fettle::core::geometry {

void scale_mesh(Mesh& mesh, const Vector3& factors) {
    mesh.vertices = factors.asDiagonal() * mesh.vertices;
    if (factors.prod() < 0) turn_triangles(mesh);
    if (!mesh.deviation) return;
    const double most = (1 + 0x1p-50) * factors.cwiseAbs().maxCoeff();
    mesh.deviation->out *= most;
    mesh.deviation->in *= most;
    mesh.deviation->declared *= most;
}

void turn_triangles(Mesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    const std::vector<Edge> edges = mesh.edges;  // those of triangles are found again, the others kept
    build_connectivity(mesh, edges);
}

std::vector<Mesh> split_parts(const Mesh& mesh, const std::vector<int>& part_of_shell, int count) {
    std::vector<std::vector<Triangle>> triangles(static_cast<std::size_t>(count));
    std::vector<std::vector<int>> faces(triangles.size());
    std::vector<std::string> names(triangles.size());
    for (std::size_t s = part_of_shell.size(); s-- > 0;) names[part_of_shell[s]] = mesh.shell_names[s];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const int part = part_of_shell[mesh.triangle_shell[t]];
        triangles[part].push_back(mesh.triangles[t]);
        if (!mesh.triangle_face.empty()) faces[part].push_back(mesh.triangle_face[t]);
    }
    std::vector<Mesh> parts;
    std::vector<int> new_index(mesh.vertices.cols(), -1);
    for (std::size_t part = 0; part < triangles.size(); ++part) {
        std::vector<int> kept;
        for (const auto& triangle : triangles[part]) kept.insert(kept.end(), triangle.begin(), triangle.end());
        std::sort(kept.begin(), kept.end());
        kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
        for (std::size_t i = 0; i < kept.size(); ++i) new_index[kept[i]] = static_cast<int>(i);
        for (auto& triangle : triangles[part]) {
            for (int& v : triangle) v = new_index[v];
        }
        parts.push_back(make_mesh(names[part], mesh.vertices(Eigen::all, kept), std::move(triangles[part])));
        parts.back().triangle_face = std::move(faces[part]);
        parts.back().face_names = mesh.face_names;
        parts.back().deviation = mesh.deviation;
        parts.back().colour = mesh.colour;
    }
    return parts;
}

}  // namespace fettle::core::geometry
