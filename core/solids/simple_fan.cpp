// SPDX-License-Identifier: MIT
#include "core/solids/simple_fan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/predicates.hpp"

namespace fettle::core::solids {
namespace {

constexpr std::size_t most_looked_through = 16;

/// Do they make one cycle: from each to the next, back to the first after all of them?
bool make_one_cycle(std::vector<FanSector>& sectors) {
    const std::size_t count = sectors.size();
    const bool many = count > most_looked_through;
    const auto by_start = [](const FanSector& a, const FanSector& b) { return a.from < b.from; };
    if (many) std::sort(sectors.begin(), sectors.end(), by_start);
    std::size_t at = 0;
    for (std::size_t steps = 1; steps <= count; ++steps) {
        const int next = sectors[at].to;
        if (next == sectors[0].from) return steps == count;
        const auto found = many ? std::lower_bound(sectors.begin(), sectors.end(), FanSector{next, 0}, by_start)
                                : std::find_if(sectors.begin(), sectors.end(), [&](const FanSector& s) { return s.from == next; });
        if (found == sectors.end() || found->from != next) return false;
        at = static_cast<std::size_t>(found - sectors.begin());
    }
    return false;
}

/// Seen along a coordinate axis. A turn by less than half a turn that goes from below the vertex to its height or above passes the
/// direction to the right, once: so often they turn round the vertex.
bool is_simple_along_axis(const geometry::Mesh& mesh, int vertex, const std::vector<FanSector>& sectors, const Vector3& normal) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto seen = [&](int v) {
        const Vector2 p = geometry::projected(mesh.vertices.col(v), axis);
        return normal[axis] < 0 ? Vector2(p.y(), p.x()) : p;
    };
    const Vector2 centre = seen(vertex);
    int turns = 0;
    for (const FanSector& s : sectors) {
        const Vector2 from = seen(s.from), to = seen(s.to);
        if (geometry::orient2d(centre, from, to) <= 0) return false;
        turns += from.y() < centre.y() && to.y() >= centre.y() ? 1 : 0;
    }
    return turns == 1;
}

/// The same seen from a point above the vertex, with the first spoke as the direction that is passed.
bool is_simple_from_above(const geometry::Mesh& mesh, int vertex, const std::vector<FanSector>& sectors, const Vector3& above) {
    const Vector3 centre = mesh.vertices.col(vertex), first = mesh.vertices.col(sectors[0].from);
    const auto is_below = [&](int v) { return v != sectors[0].from && geometry::orient3d(centre, above, first, mesh.vertices.col(v)) < 0; };
    int turns = 0;
    for (const FanSector& s : sectors) {
        if (geometry::orient3d(centre, mesh.vertices.col(s.from), mesh.vertices.col(s.to), above) <= 0) return false;
        turns += is_below(s.from) && !is_below(s.to) ? 1 : 0;
    }
    return turns == 1;
}

}  // namespace

VertexCorners::VertexCorners(const geometry::Mesh& mesh) : first_(static_cast<std::size_t>(mesh.vertices.cols()) + 1, 0) {
    for (const geometry::Triangle& t : mesh.triangles)
        for (const int v : t) ++first_[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<int> next(first_.begin(), first_.end() - 1);
    corners_.resize(3 * mesh.triangles.size());
    int corner = 0;
    for (const geometry::Triangle& t : mesh.triangles)
        for (const int v : t) corners_[next[v]++] = corner++;
}

bool FanCheck::is_simple(int vertex) {
    const geometry::Mesh& mesh = mesh_;
    std::vector<FanSector>& sectors = sectors_;
    sectors.clear();
    const Vector3 centre = mesh.vertices.col(vertex);
    Vector3 normal = Vector3::Zero(), upwards = Vector3::Zero();
    double reach = 0;
    for (const int* c = corners_.begin(vertex); c != corners_.end(vertex); ++c) {
        const geometry::Triangle& t = mesh.triangles[*c / 3];
        const int k = *c % 3;
        sectors.push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
        const Vector3 from = mesh.vertices.col(sectors.back().from) - centre, to = mesh.vertices.col(sectors.back().to) - centre;
        normal += from.cross(to);
        reach = std::max(reach, from.cwiseAbs().maxCoeff());
    }
    if (sectors.size() < 3 || !make_one_cycle(sectors)) return false;
    if (is_simple_along_axis(mesh, vertex, sectors, normal)) return true;
    for (const FanSector& s : sectors) {
        const Vector3 n = (mesh.vertices.col(s.from) - centre).cross(mesh.vertices.col(s.to) - centre);
        const double size = n.norm();
        if (size > 0) upwards += n / size;
    }
    const Vector3 above = centre + reach * upwards;
    return above.allFinite() && is_simple_from_above(mesh, vertex, sectors, above);
}

}  // namespace fettle::core::solids
