// SPDX-License-Identifier: MIT
#include "core/parts/flat_faces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace fettle::core::parts {
namespace {

struct FlatFace {
    std::size_t solid = 0;
    std::set<int> corners;
    Vector3 normal = Vector3::Zero();  ///< as long as twice the area
};

std::vector<FlatFace> faces_of(const FacedMesh& solid, std::size_t which) {
    std::map<int, FlatFace> found;
    for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
        if (solid.face[t] < 0) continue;
        FlatFace& face = found[solid.face[t]];
        face.solid = which;
        const auto corner = [&](std::size_t k) { return Vector3(solid.mesh.vertices.col(solid.mesh.triangles[t][k])); };
        face.normal += (corner(1) - corner(0)).cross(corner(2) - corner(0));
        face.corners.insert(solid.mesh.triangles[t].begin(), solid.mesh.triangles[t].end());
    }
    std::vector<FlatFace> out;
    for (auto& [key, face] : found) out.push_back(std::move(face));
    return out;
}

bool lies_in(const FlatFace& face, const Matrix3X& vertices, const FlatPlane& plane, double rounding) {
    return std::all_of(face.corners.begin(), face.corners.end(),
                       [&](int v) { return std::abs(plane.normal.dot(vertices.col(v)) - plane.offset) <= rounding; });
}

FlatPlane plane_of(const FlatFace& face, const Matrix3X& vertices) {
    FlatPlane out{face.normal / face.normal.cwiseAbs().maxCoeff(), 0};
    double low = INFINITY, high = -INFINITY;
    for (const int v : face.corners) {
        low = std::min(low, out.normal.dot(vertices.col(v)));
        high = std::max(high, out.normal.dot(vertices.col(v)));
    }
    out.offset = low == high ? low : low + (high - low) / 2;
    return out;
}

// Does a plane cut the others at an angle that says where?
bool is_independent(const std::vector<int>& of_vertex, const FlatPlane& plane, const std::vector<FlatPlane>& planes) {
    constexpr double least = 1e-3;
    const Vector3 n = plane.normal.normalized();
    const auto normal = [&](std::size_t k) { return Vector3(planes[of_vertex[k]].normal.normalized()); };
    if (of_vertex.empty()) return true;
    if (of_vertex.size() == 1) return n.cross(normal(0)).norm() > least;
    return of_vertex.size() == 2 && std::abs(n.dot(normal(0).cross(normal(1)))) > least;
}

}  // namespace

FlatFaces flat_faces(const FacedMesh& a, const FacedMesh& b, double rounding) {
    const std::array<const FacedMesh*, 2> solids{&a, &b};
    std::vector<FlatFace> faces;
    FlatFaces out;
    for (std::size_t k = 0; k < 2; ++k) {
        for (FlatFace& face : faces_of(*solids[k], k)) faces.push_back(std::move(face));
        out.of_vertex[k].resize(static_cast<std::size_t>(solids[k]->mesh.vertices.cols()));
    }
    // Large ones first: their planes are known best.
    std::stable_sort(faces.begin(), faces.end(),
                     [](const FlatFace& x, const FlatFace& y) { return x.normal.squaredNorm() > y.normal.squaredNorm(); });
    for (const FlatFace& face : faces) {
        if (!(face.normal.cwiseAbs().maxCoeff() > 0)) continue;
        const Matrix3X& vertices = solids[face.solid]->mesh.vertices;
        const auto known = std::find_if(out.planes.begin(), out.planes.end(),
                                        [&](const FlatPlane& plane) { return lies_in(face, vertices, plane, rounding); });
        const int plane = static_cast<int>(known - out.planes.begin());
        if (known == out.planes.end()) out.planes.push_back(plane_of(face, vertices));
        for (const int v : face.corners) {
            std::vector<int>& of_vertex = out.of_vertex[face.solid][v];
            if (is_independent(of_vertex, out.planes[plane], out.planes)) of_vertex.push_back(plane);
        }
    }
    return out;
}

}  // namespace fettle::core::parts
