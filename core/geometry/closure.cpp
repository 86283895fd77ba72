// SPDX-License-Identifier: MIT
#include "fettle/core/geometry/closure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fettle/core/geometry/mass_moments.hpp"

namespace fettle::core::geometry {
namespace {

constexpr double next_to_none = 1e-6;  // of its area to the power 3/2: a volume that is none

double distance_to_segment(const Vector3& x, const Vector3& a, const Vector3& b) {
    const Vector3 along = b - a;
    const double length_squared = along.squaredNorm();
    const double t = length_squared > 0 ? std::clamp(along.dot(x - a) / length_squared, 0.0, 1.0) : 0;
    return (a + t * along - x).norm();
}

}  // namespace

std::optional<Closure> closure_of(const Mesh& mesh) {
    const std::vector<Opening> found = openings(mesh.vertices, mesh.triangles);
    if (found.empty()) return std::nullopt;
    Closure out;
    const Eigen::Index own = mesh.vertices.cols();
    out.vertices.resize(3, own + static_cast<Eigen::Index>(found.size()));
    out.vertices.leftCols(own) = mesh.vertices;
    out.triangles = mesh.triangles;
    out.first_lid = mesh.triangles.size();
    for (std::size_t k = 0; k < found.size(); ++k) {
        const Opening& opening = found[k];
        const auto middle = static_cast<int>(own + static_cast<Eigen::Index>(k));
        out.vertices.col(middle) = opening.centre;
        for (const Edge& edge : opening.edges) {
            out.triangles.push_back({edge[1], edge[0], middle});
            // The distance from the edge is convex over the lid's triangle, and 0 at two of its corners.
            out.reach = std::max(out.reach, distance_to_segment(opening.centre, mesh.vertices.col(edge[0]), mesh.vertices.col(edge[1])));
        }
    }
    const double area = surface_moments(out.vertices, out.triangles)(3, 3);
    if (!(std::abs(solid_moments(out.vertices, out.triangles)(3, 3)) > next_to_none * area * std::sqrt(area))) return std::nullopt;
    const double size = (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
    out.reach += 1e-14 * (size + out.vertices.cwiseAbs().maxCoeff());  // rounding
    return out;
}

Mesh lids_of(const Closure& closure) {
    std::vector<int> index(static_cast<std::size_t>(closure.vertices.cols()), -1);
    std::vector<int> used;
    std::vector<Triangle> triangles(closure.triangles.begin() + static_cast<std::ptrdiff_t>(closure.first_lid), closure.triangles.end());
    for (Triangle& t : triangles)
        for (int& v : t) {
            int& known = index[static_cast<std::size_t>(v)];
            if (known < 0) {
                known = static_cast<int>(used.size());
                used.push_back(v);
            }
            v = known;
        }
    return make_mesh("lids", closure.vertices(Eigen::all, used), std::move(triangles));
}

}  // namespace fettle::core::geometry
