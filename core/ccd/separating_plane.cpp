// SPDX-License-Identifier: MIT
#include "core/ccd/separating_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/rounding.hpp"
#include "core/geometry/accurate_cross.hpp"

namespace fettle::core::ccd {

using geometry::accurate_cross;

namespace {

/// Squares of sines: below the first directions are parallel as far as rounding lets see, below the second cross products cancel.
constexpr double parallel = 64 * unit_roundoff * unit_roundoff, nearly_parallel = 1e-10;
constexpr double largest_usable = 1e150;

/// Squares of lengths between these neither overflow nor lose bits.
constexpr double least_square = 1e-280, largest_square = 1e280;

Vector3 row(const Differences& r, Eigen::Index i) { return {r(i, 0), r(i, 1), r(i, 2)}; }

/// n . r_ij, summed in one order whatever the instructions.
Lanes along(const Vector3& n, const Differences& r) { return n.x() * r.col(0) + n.y() * r.col(1) + n.z() * r.col(2); }

Lanes dot(const Differences& a, const Differences& b) { return a.col(0) * b.col(0) + a.col(1) * b.col(1) + a.col(2) * b.col(2); }

/// The unit vector along `direction`, its length right within 6u: by squares 1.5u, root, quotient, product u/2 to u each; zero if there is
/// none.
Vector3 unit(const Vector3& direction) {
    const double square = direction.squaredNorm();
    if (square >= least_square && square <= largest_square) return direction * (1 / std::sqrt(square));
    const double size = direction.cwiseAbs().maxCoeff();
    if (!(size > 0) || !std::isfinite(size)) return Vector3::Zero();
    const Vector3 n = direction / size;
    return n / n.norm();
}

/// Orients the plane and sets limit and gap from the values at the time asked for.
void judge(SeparatingPlane& s, const Lanes& values, const Vector3& largest, double dmin) {
    double least = values.minCoeff();
    const double most = values.maxCoeff();
    if (-most > least) {
        s.n = -s.n;
        s.p = -s.p;
        s.q = -s.q;
        least = -most;
    }
    const double error = 8 * unit_roundoff * s.n.cwiseAbs().dot(largest) + 1e-290;
    s.limit = dmin * (1 + 16 * unit_roundoff) + 1.01 * error;
    const double gap = least - s.limit;
    if (gap > 0) s.gap = gap;
}

/// The vertex-edge cases, one per lane: point and triangle have three, the last repeated.
struct PointEdges {
    Differences to_start, edge;  // vertex less the edge's start; the edge
};
PointEdges point_edges(geometry::PairType type, const Differences& r) {
    PointEdges pe;
    for (Eigen::Index k = 0; k < 3; ++k) {
        const double r0 = r(0, k), r1 = r(1, k), r2 = r(2, k);
        if (type == geometry::PairType::point_triangle) {
            pe.to_start.col(k) << r0, r1, r2, r2;
            pe.edge.col(k) << r0 - r1, r1 - r2, r2 - r0, r2 - r0;
        } else {
            pe.to_start.col(k) << r0, r2, -r0, -r1;
            pe.edge.col(k) << r0 - r1, r0 - r1, r2 - r0, r2 - r0;
        }
    }
    return pe;
}

/// The corner of a triangle across from its longest edge.
Eigen::Index corner_of_shorter_edges(const Differences& r) {
    const double e01 = (row(r, 0) - row(r, 1)).squaredNorm(), e12 = (row(r, 1) - row(r, 2)).squaredNorm(),
                 e20 = (row(r, 2) - row(r, 0)).squaredNorm();
    if (e12 >= e01) return e12 >= e20 ? 0 : 1;
    return e01 >= e20 ? 2 : 1;
}

/// The closest of the vertex-edge cases.
ClosestDirection closest_point_edge(geometry::PairType type, const Differences& r) {
    const PointEdges pe = point_edges(type, r);
    const Lanes length_squared = dot(pe.edge, pe.edge).max(1e-300);
    const Lanes s = (dot(pe.to_start, pe.edge) / length_squared).max(0.0).min(1.0);
    Differences difference;
    for (Eigen::Index k = 0; k < 3; ++k) difference.col(k) = pe.to_start.col(k) - s * pe.edge.col(k);
    const Lanes squares = dot(difference, difference);
    Eigen::Index best = 0;
    const double least = squares.minCoeff(&best);
    Vector3 direction = row(difference, best);
    if (s[best] > 0 && s[best] < 1) {
        const Vector3 e = row(pe.edge, best);
        const double inverse = 1 / length_squared[best];
        for (int twice = 0; twice < 2; ++twice) direction -= (direction.dot(e) * inverse) * e;
    }
    return {direction, least};
}

/// Where the closest points may lie within both primitives, by normals a x b of a face or two edges.
struct Inside {
    Vector3 w, a, b;
};
Inside inside_case(geometry::PairType type, const Differences& r) {
    // Triangle: the two shorter edges, and the point, from the vertex they share (in a sliver the longer ones are parallel to rounding).
    // Edges: both, and the difference of their starts.
    const bool face = type == geometry::PairType::point_triangle;
    const Eigen::Index c = face ? corner_of_shorter_edges(r) : 0;
    const Vector3 w = row(r, c);
    return {w, face ? w - row(r, (c + 1) % 3) : row(r, 2) - w, face ? w - row(r, (c + 2) % 3) : w - row(r, 1)};
}

/// @param first, second  (w x b) . n and (a x w) . n
bool lies_inside(geometry::PairType type, double first, double second, double nn) {
    if (type == geometry::PairType::point_triangle) return first > 0 && second > 0 && nn - first - second > 0;
    return -first > 0 && -first < nn && second > 0 && second < nn;
}

/// For slivers and nearly parallel edges.
ClosestDirection closest_nearly_parallel(geometry::PairType type, const Differences& r, const Inside& i) {
    const Vector3 n = accurate_cross(i.a, i.b);
    const double nn = n.squaredNorm();
    const ClosestDirection boundary = closest_point_edge(type, r);
    if (!(nn > parallel * (i.a.squaredNorm() * i.b.squaredNorm()))) return boundary;
    if (!lies_inside(type, accurate_cross(i.w, i.b).dot(n), accurate_cross(i.a, i.w).dot(n), nn)) return boundary;
    return {n, boundary.distance_squared};
}

}  // namespace

Differences differences(geometry::PairType type, const geometry::PairVertices& x) {
    Differences r;
    for (Eigen::Index k = 0; k < 3; ++k) {
        if (type == geometry::PairType::point_triangle) {
            r.col(k) << x[0][k] - x[1][k], x[0][k] - x[2][k], x[0][k] - x[3][k], x[0][k] - x[3][k];
        } else {
            r.col(k) << x[0][k] - x[2][k], x[0][k] - x[3][k], x[1][k] - x[2][k], x[1][k] - x[3][k];
        }
    }
    return r;
}

RelativeMotion relative_motion(geometry::PairType type, const geometry::PairVertices& t0, const geometry::PairVertices& t1) {
    RelativeMotion m{type, differences(type, t0), differences(type, t1), Vector3::Zero(), false};
    const Differences largest = m.d.abs().max(m.e.abs());
    m.largest = largest.colwise().maxCoeff().matrix().transpose();
    // Comparisons pass over what is not a number: a difference of it with itself does not.
    m.usable = ((m.d - m.d) + (m.e - m.e)).sum() == 0 && m.largest.maxCoeff() < largest_usable;
    return m;
}

bool separated_along_axis(const RelativeMotion& m, double dmin) {
    const double limit = dmin * (1 + 16 * unit_roundoff);
    const Differences low = m.d.min(m.e), high = m.d.max(m.e);
    for (Eigen::Index k = 0; k < 3; ++k) {
        if (low.col(k).minCoeff() > limit || high.col(k).maxCoeff() < -limit) return true;
    }
    return false;
}

SeparatingPlane separating_plane(const RelativeMotion& m, const Vector3& direction, double dmin, double t) {
    SeparatingPlane s;
    s.n = unit(direction);
    s.p = along(s.n, m.d);
    s.q = along(s.n, m.e);
    judge(s, s.values(t), m.largest, dmin);
    return s;
}

SeparatingPlane separating_plane_at_rest(const Differences& r, const Vector3& largest, const Vector3& direction, double dmin) {
    SeparatingPlane s;
    s.n = unit(direction);
    s.p = along(s.n, r);
    judge(s, s.p, largest, dmin);
    return s;
}

ClosestDirection closest_direction(geometry::PairType type, const Differences& r) {
    const Inside i = inside_case(type, r);
    const Vector3 n = i.a.cross(i.b);
    const double nn = n.squaredNorm();
    if (!(nn > nearly_parallel * (i.a.squaredNorm() * i.b.squaredNorm()))) return closest_nearly_parallel(type, r, i);
    // By cross products rather than sums of products of lengths: resolves angles down to rounding instead of its square root.
    if (!lies_inside(type, i.w.cross(i.b).dot(n), i.a.cross(i.w).dot(n), nn)) return closest_point_edge(type, r);
    const double height = n.dot(i.w);
    return {n, height * height / nn};
}

CandidateDirections candidate_directions(geometry::PairType type, const Differences& r) {
    CandidateDirections c;
    const auto add = [&](const Vector3& direction) { c.direction[c.count++] = direction; };
    const PointEdges pe = point_edges(type, r);
    const bool face = type == geometry::PairType::point_triangle;
    for (Eigen::Index i = 0; i < (face ? 3 : 4); ++i) {
        const Vector3 w = row(pe.to_start, i), e = row(pe.edge, i);
        if (face) add(accurate_cross(e, row(pe.edge, (i + 1) % 3)));
        const double ee = e.squaredNorm();
        add(w - (ee > 0 ? std::clamp(w.dot(e) / ee, 0.0, 1.0) : 0.0) * e);
        add(accurate_cross(accurate_cross(e, w), e));
        add(w);
    }
    if (!face) add(accurate_cross(row(pe.edge, 0), row(pe.edge, 2)));
    for (int k = 0; k < 3; ++k) add(Vector3::Unit(k));
    return c;
}

}  // namespace fettle::core::ccd
