// SPDX-License-Identifier: MIT
#include "core/clearance/witness_instant.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

#include "core/base/contract.hpp"

namespace fettle::core::clearance {
namespace {

Vector3 angular_rate(const kinematics::PathSegment& path, double s) {
    return kinematics::left_jacobian(path.rotation_vector_t0 + s * path.rotation_vector_step) * path.rotation_vector_step;
}

// Zero at distance 0.
double rate_of(const PairSegment& segment, const Instant& at, const ElementPairDistance& pair) {
    if (!(pair.distance > 0)) return 0;
    const Vector3 arm_a = pair.point_a - at.offset, arm_b = pair.point_b;
    const Vector3 velocity = angular_rate(segment.a->path, at.s).cross(arm_a) - angular_rate(segment.b->path, at.s).cross(arm_b) +
                             (segment.a->path.position_step - segment.b->path.position_step);
    return velocity.dot(pair.difference) / pair.distance;
}

}  // namespace

ElementPairDistance placed_distance(const Instant& at, const Corners& corners_a, const Corners& corners_b,
                                    const ElementPairDistance* before) {
    return element_pair_distance({(at.rotation_a * corners_a.x).colwise() + at.offset, corners_a.count},
                                 {at.rotation_b * corners_b.x, corners_b.count}, before);
}

double least_distance_near(const PairSegment& segment, const Corners& corners_a, const Corners& corners_b, double s) {
    ElementPairDistance pair;
    const auto rate = [&](double there, const ElementPairDistance* before) {
        const Instant at = instant_at(segment, there);
        pair = placed_distance(at, corners_a, corners_b, before);
        return rate_of(segment, at, pair);
    };
    const double here = rate(s, nullptr);
    if (here == 0) return s;
    // Downhill in growing steps until the rate changes sign.
    const double direction = here > 0 ? -1 : 1;
    double inside = s, beyond = s;
    for (double step = 0x1p-24;; step *= 4) {
        beyond = std::clamp(s + direction * step, 0.0, 1.0);
        if (rate(beyond, &pair) * here <= 0) break;
        if (beyond == 0 || beyond == 1) return beyond;
        inside = beyond;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + beyond);
        if (middle == inside || middle == beyond) break;
        (rate(middle, &pair) * here > 0 ? inside : beyond) = middle;
    }
    return 0.5 * (inside + beyond);
}

Encounter refined(const PairSegment& segment, const PieceTree& a, const PieceTree& b, const Encounter& encounter) {
    const Corners &corners_a = a.elements[encounter.element_a].corners, &corners_b = b.elements[encounter.element_b].corners;
    Encounter found = encounter;
    found.s = least_distance_near(segment, corners_a, corners_b, encounter.s);
    found.pair = placed_distance(instant_at(segment, found.s), corners_a, corners_b);
    // A flat minimum: the better instant's distance may differ by rounding only.
    const double allowed = (encounter.pair.distance + segment.slack) * (1 + 4 * std::numeric_limits<double>::epsilon());
    return found.pair.distance + segment.slack <= allowed ? found : encounter;
}

Witness witness_between(const PieceTree& a, const PieceTree& b, int element_a, int element_b, const ElementPairDistance& found) {
    Witness w;
    w.kind_a = found.kind_a;
    w.kind_b = found.kind_b;
    w.edge_edge = found.kind_a == Primitive::edge && found.kind_b == Primitive::edge;
    w.vertex_on_a = found.kind_a == Primitive::vertex;
    w.primitive_a = primitive_index(a, element_a, found.kind_a, found.corner_a);
    w.primitive_b = primitive_index(b, element_b, found.kind_b, found.corner_b);
    w.point_a = found.point_a;
    w.point_b = found.point_b;
    w.distance = found.distance;
    return w;
}

int primitive_index(const PieceTree& tree, int element, Primitive kind, int corner) {
    const PieceElement& e = tree.elements[element];
    if (kind == Primitive::triangle) return e.primitive;
    if (kind == Primitive::vertex) return e.vertices[corner];
    if (e.corners.count == 2) return e.primitive;
    const int v0 = e.vertices[corner], v1 = e.vertices[(corner + 1) % 3];
    const auto same = [&](const geometry::Edge& edge) { return (edge[0] == v0 && edge[1] == v1) || (edge[0] == v1 && edge[1] == v0); };
    const auto& edges = tree.mesh->edges;
    const auto found = std::find_if(edges.begin(), edges.end(), same);
    FETTLE_ASSERT(found != edges.end(), "mesh " + tree.mesh->name + " does not list an edge of its triangles");
    return static_cast<int>(found - edges.begin());
}

}  // namespace fettle::core::clearance
