// SPDX-License-Identifier: MIT
#include "core/features/wall.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "core/base/limits.hpp"
#include "core/geometry/body_hierarchy.hpp"

namespace fettle::core::features {

namespace {

Vector3 area_of(const Matrix3X& x, const geometry::Triangle& t) {
    const Vector3 from = x.col(t[0]);
    return 0.5 * (x.col(t[1]) - from).cross(x.col(t[2]) - from);
}

// From `from` along `way`: the length to the triangle's plane within it; infinity: it is missed.
double hit(const Matrix3X& x, const geometry::Triangle& t, const Vector3& from, const Vector3& way) {
    const Vector3 a = x.col(t[0]), u = x.col(t[1]) - a, v = x.col(t[2]) - a, p = way.cross(v);
    const double determinant = u.dot(p);
    if (std::abs(determinant) < 1e-300) return infinity;
    const Vector3 s = from - a;
    const double b = s.dot(p) / determinant;
    const Vector3 q = s.cross(u);
    const double c = way.dot(q) / determinant;
    if (b < 0 || c < 0 || b + c > 1) return infinity;
    const double length = v.dot(q) / determinant;
    return length > 0 ? length : infinity;
}

// Rays against all triangles of a mesh but some.
class Rays {
public:
    Rays(const geometry::Mesh& mesh, const std::vector<int>& left_out)
        : mesh_(mesh), hierarchy_(mesh), is_left_out_(mesh.triangles.size(), 0) {
        for (const int t : left_out) is_left_out_[t] = 1;
    }

    // How far the nearest one is, if that is less than `within`; infinity: none is.
    double first_hit(const Vector3& from, const Vector3& way, double within) const {
        double least = infinity;
        std::vector<int> open{0};
        while (!open.empty()) {
            const geometry::HierarchyNode& node = hierarchy_.nodes()[open.back()];
            open.pop_back();
            if (!may_hit(node, from, way, std::min(least, within))) continue;
            if (!node.is_leaf()) {
                open.push_back(node.left);
                open.push_back(node.right);
                continue;
            }
            for (int e = node.first; e < node.first + node.count; ++e) {
                const int t = hierarchy_.elements()[e].triangle;
                if (t >= 0 && is_left_out_[t] == 0) least = std::min(least, hit(mesh_.vertices, mesh_.triangles[t], from, way));
            }
        }
        return least < within ? least : infinity;
    }

private:
    static bool may_hit(const geometry::HierarchyNode& node, const Vector3& from, const Vector3& way, double within) {
        double enter = 0, leave = within;
        for (int k = 0; k < 3; ++k) {
            const double low = node.center[k] - node.half_extent[k] - from[k], high = node.center[k] + node.half_extent[k] - from[k];
            if (way[k] == 0) {
                if (low > 0 || high < 0) return false;
                continue;
            }
            const auto [first, last] = std::minmax({low / way[k], high / way[k]});
            enter = std::max(enter, first);
            leave = std::min(leave, last);
        }
        return enter <= leave * (1 + 1e-12);
    }

    const geometry::Mesh& mesh_;
    const geometry::BodyHierarchy hierarchy_;
    std::vector<char> is_left_out_;
};

}  // namespace

std::optional<Wall> wall_behind(const geometry::Mesh& mesh, const Feature& feature) {
    const Rays rays(mesh, feature.triangles);
    std::optional<Wall> least;
    for (const int t : feature.triangles) {
        const auto& corners = mesh.triangles[t];
        const Vector3 inwards = -area_of(mesh.vertices, corners).normalized();
        const Vector3 middle = (mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) + mesh.vertices.col(corners[2])) / 3;
        for (std::size_t k = 0; k < 4; ++k) {
            // A little within the facet, so that no ray runs along a neighbour.
            const Vector3 from = k == 3 ? middle : Vector3(middle + 0.98 * (mesh.vertices.col(corners[k]) - middle));
            const double length = rays.first_hit(from, inwards, least ? least->thickness : infinity);
            if (length < infinity && (!least || length < least->thickness)) least = Wall{length, from};
        }
    }
    return least;
}

}  // namespace fettle::core::features
