// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>

#include "fettle/core/geometry/predicates.hpp"
#include "fettle/core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

using geometry::orient2d;
using geometry::Triangle;

/// A corner in the plane, counter-clockwise outline.
struct Corner {
    Vector2 x;
    int vertex;
};

bool is_ear(const std::vector<Corner>& outline, std::size_t i) {
    const std::size_t n = outline.size();
    const Vector2 &a = outline[(i + n - 1) % n].x, &b = outline[i].x, &c = outline[(i + 1) % n].x;
    if (orient2d(a, b, c) <= 0) return false;
    for (const Corner& other : outline) {
        const Vector2& p = other.x;
        if (p == a || p == b || p == c) continue;
        // Also a corner on the diagonal c a blocks: cutting there would leave a piece without area.
        if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) return false;
    }
    return true;
}

Vector3 newell_normal(const std::vector<Vector3>& vertices, const int* corners, int count) {
    Vector3 normal = Vector3::Zero();
    for (int i = 0; i < count; ++i) {
        const Vector3 a = vertices[corners[i]] - vertices[corners[0]], b = vertices[corners[(i + 1) % count]] - vertices[corners[0]];
        normal += a.cross(b);
    }
    return normal;
}

}  // namespace

std::vector<Triangle> triangulated(const std::vector<Vector3>& vertices, const int* corners, int count) {
    if (count == 3) return {{corners[0], corners[1], corners[2]}};
    const Vector3 normal = newell_normal(vertices, corners, count);
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    std::vector<Corner> outline;
    for (int i = 0; i < count; ++i) {
        Vector2 x = geometry::projected(vertices[corners[i]], axis);
        if (normal(axis) < 0) x.x() = -x.x();
        outline.push_back({x, corners[i]});
    }
    std::vector<Triangle> triangles;
    while (outline.size() > 3) {
        std::size_t ear = 1;
        while (ear <= outline.size() && !is_ear(outline, ear % outline.size())) ++ear;
        if (ear > outline.size()) return {};
        const std::size_t n = outline.size(), i = ear % n;
        triangles.push_back({outline[(i + n - 1) % n].vertex, outline[i].vertex, outline[(i + 1) % n].vertex});
        outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(i));
    }
    triangles.push_back({outline[0].vertex, outline[1].vertex, outline[2].vertex});
    return triangles;
}

}  // namespace fettle::core::mesh_files
