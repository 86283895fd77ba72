// SPDX-License-Identifier: MIT
#include "core/solids/closure.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "core/geometry/mass_moments.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::solids {
namespace {

constexpr double next_to_none = 1e-6;  // of the root of its area: how thick a sheet may be that is flat

double distance_to_segment(const Vector3& x, const Vector3& a, const Vector3& b) {
    const Vector3 along = b - a;
    const double length_squared = along.squaredNorm();
    const double t = length_squared > 0 ? std::clamp(along.dot(x - a) / length_squared, 0.0, 1.0) : 0;
    return (a + t * along - x).norm();
}

/// Triangles that hang together by their corners, each list a part.
std::vector<std::vector<geometry::Triangle>> connected_parts(const std::vector<geometry::Triangle>& triangles, std::size_t vertices) {
    std::vector<int> parent(vertices);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const geometry::Triangle& t : triangles)
        for (std::size_t k = 1; k < 3; ++k) parent[root(t[k])] = root(t[0]);
    std::map<int, std::vector<geometry::Triangle>> parts;
    for (const geometry::Triangle& t : triangles) parts[root(t[0])].push_back(t);
    std::vector<std::vector<geometry::Triangle>> out;
    for (auto& [representative, part] : parts) out.push_back(std::move(part));
    return out;
}

/// Do all triangles lie between two planes that are next to no distance apart? Along the axis in which they spread least.
bool is_flat(const Matrix3X& vertices, const std::vector<geometry::Triangle>& triangles) {
    const Vector3 origin = vertices.col(triangles.front()[0]);
    double area = 0;
    Vector3 first = Vector3::Zero();
    Matrix3 second = Matrix3::Zero();
    for (const geometry::Triangle& t : triangles) {
        std::array<Vector3, 3> x;
        for (std::size_t k = 0; k < 3; ++k) x[k] = vertices.col(t[k]) - origin;
        const double share = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
        area += share;
        for (std::size_t k = 0; k < 3; ++k) {  // exact to second order
            const Vector3 middle = 0.5 * (x[k] + x[(k + 1) % 3]);
            first += share / 3 * middle;
            second += share / 3 * middle * middle.transpose();
        }
    }
    if (area == 0) return true;
    const Eigen::SelfAdjointEigenSolver<Matrix3> axes(second - first * first.transpose() / area);
    const Vector3 across = axes.eigenvectors().col(0);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const geometry::Triangle& t : triangles) {
        for (const int v : t) {
            const double height = across.dot(vertices.col(v) - origin);
            low = std::min(low, height);
            high = std::max(high, height);
        }
    }
    return high - low <= next_to_none * std::sqrt(area);
}

}  // namespace

std::optional<Closure> closure_of(const geometry::Mesh& mesh) {
    const std::vector<geometry::Opening> found = geometry::openings(mesh.vertices, mesh.triangles);
    if (found.empty()) return std::nullopt;
    Closure out;
    const Eigen::Index own = mesh.vertices.cols();
    out.vertices.resize(3, own + static_cast<Eigen::Index>(found.size()));
    out.vertices.leftCols(own) = mesh.vertices;
    out.triangles = mesh.triangles;
    out.first_lid = mesh.triangles.size();
    for (std::size_t k = 0; k < found.size(); ++k) {
        const geometry::Opening& opening = found[k];
        const auto middle = static_cast<int>(own + static_cast<Eigen::Index>(k));
        out.vertices.col(middle) = opening.centre;
        for (const geometry::Edge& edge : opening.edges) {
            out.triangles.push_back({edge[1], edge[0], middle});
            // The distance from the edge is convex over the lid's triangle, and 0 at two of its corners.
            out.reach = std::max(out.reach, distance_to_segment(opening.centre, mesh.vertices.col(edge[0]), mesh.vertices.col(edge[1])));
        }
    }
    // Not by the signed volume: parts, or faces, that are turned over cancel what is there.
    const auto parts = connected_parts(out.triangles, static_cast<std::size_t>(out.vertices.cols()));
    if (std::all_of(parts.begin(), parts.end(), [&](const auto& part) { return is_flat(out.vertices, part); })) return std::nullopt;
    const double size = geometry::box_sides(mesh.vertices).norm();
    out.reach += 1e-14 * (size + out.vertices.cwiseAbs().maxCoeff());  // rounding
    return out;
}

bool is_within(const Vector3& point, const Closure& closure) {
    return winding_number(point, closure.vertices, closure.triangles).value_or(1) != 0;
}

geometry::Mesh lids_of(const Closure& closure) {
    std::vector<int> index(closure.vertices.cols(), -1);
    std::vector<int> used;
    std::vector<geometry::Triangle> triangles(closure.triangles.begin() + static_cast<std::ptrdiff_t>(closure.first_lid),
                                              closure.triangles.end());
    for (geometry::Triangle& t : triangles)
        for (int& v : t) {
            int& known = index[v];
            if (known < 0) {
                known = count_of(used);
                used.push_back(v);
            }
            v = known;
        }
    return geometry::make_mesh("lids", closure.vertices(Eigen::all, used), std::move(triangles));
}

}  // namespace fettle::core::solids
