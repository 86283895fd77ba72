// SPDX-License-Identifier: MIT
#include "core/clearance/element_pair.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/distance.hpp"

namespace fettle::core::clearance {
namespace {

struct Piercing {
    Vector3 on_edge, on_triangle;
    int corner = 0;    // the edge's end next to the triangle
    double depth = 0;  // of that end
};

int edge_count(const Corners& element) { return element.count == 3 ? 3 : element.count - 1; }
Vector3 edge_end(const Corners& element, int k) { return element.x.col((k + 1) % 3); }

// By how much corners may be off, by norm, without undoing that an edge passes through a triangle: its ends stay beyond the plane, and the
// point where it meets the plane stays off the triangle's edges. That point goes further than the ends, the more so the flatter the edge
// lies. So an edge that only runs along a triangle's border is no clash.
double depth_of(double height_p, double height_q, double length, const Vector3& weight, const Matrix3& triangle) {
    const double twice_area = (triangle.col(1) - triangle.col(0)).cross(triangle.col(2) - triangle.col(0)).norm();
    double off_edges = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const double side = (triangle.col((i + 2) % 3) - triangle.col((i + 1) % 3)).norm();
        off_edges = std::min(off_edges, weight[i] * twice_area / side);
    }
    const double steep = std::min(1.0, (height_p + height_q) / length);
    const double depth = std::min({height_p, height_q, off_edges * steep});
    return depth > 0 ? depth : 0;
}

// Where edge k of `edges` passes through the triangle's plane, moved into the triangle by clamping: both points belong to their
// pieces whatever rounding did, so their distance is an honest upper bound.
std::optional<Piercing> piercing(const Corners& edges, int k, const Matrix3& triangle) {
    const Vector3 p = edges.x.col(k), q = edge_end(edges, k);
    const Vector3 u = triangle.col(1) - triangle.col(0), v = triangle.col(2) - triangle.col(0);
    const Vector3 normal = u.cross(v);
    const double hp = normal.dot(p - triangle.col(0)), hq = normal.dot(q - triangle.col(0));
    const double squared = normal.squaredNorm();
    if (!(squared > 0) || hp * hq > 0 || hp == hq) return std::nullopt;
    const double s = hp / (hp - hq);
    Piercing result;
    result.on_edge = p + s * (q - p);
    result.corner = s < 0.5 ? k : (k + 1) % 3;
    const Vector3 w = result.on_edge - triangle.col(0);
    Vector3 weight;
    weight[1] = w.cross(v).dot(normal) / squared;
    weight[2] = u.cross(w).dot(normal) / squared;
    weight[0] = 1 - weight[1] - weight[2];
    result.depth = depth_of(std::abs(hp) / std::sqrt(squared), std::abs(hq) / std::sqrt(squared), (q - p).norm(), weight, triangle);
    weight = weight.cwiseMax(0);
    weight /= weight.sum();
    if (!weight.allFinite()) return std::nullopt;  // a sliver whose squared area underflows: its edges are measured anyway
    result.on_triangle = triangle * weight;
    return result;
}

// Separation of the elements along the candidate's direction: its distance if they are disjoint, far from it if one pierces the other.
bool separates(const ElementPairDistance& candidate, const Corners& a, const Corners& b) {
    if (!(candidate.distance > 0)) return true;
    const Vector3 n = candidate.difference / candidate.distance;
    return (n.transpose() * a.x).minCoeff() - (n.transpose() * b.x).maxCoeff() > 0.5 * candidate.distance;
}

void look_for_piercing(const Corners& a, const Corners& b, ElementPairDistance& best) {
    for (int side = 0; side < 2; ++side) {
        const Corners &edges = side == 0 ? a : b, &triangle = side == 0 ? b : a;
        if (triangle.count != 3) continue;
        for (int k = 0; k < edge_count(edges); ++k) {
            const std::optional<Piercing> found = piercing(edges, k, triangle.x);
            if (!found) continue;
            const double distance = (found->on_edge - found->on_triangle).norm();
            if (distance >= best.distance) continue;
            best.distance = distance;
            best.intersecting = true;
            best.depth = found->depth;
            best.kind_a = side == 0 ? Primitive::vertex : Primitive::triangle;
            best.kind_b = side == 0 ? Primitive::triangle : Primitive::vertex;
            (side == 0 ? best.corner_a : best.corner_b) = found->corner;
            best.point_a = side == 0 ? found->on_edge : found->on_triangle;
            best.point_b = side == 0 ? found->on_triangle : found->on_edge;
            best.difference = best.point_a - best.point_b;
        }
    }
}

// Keeps the closest of the pairs of features it is shown. Those that the plane across the best so far keeps as far apart are not looked at:
// once it is the closest, all of them.
class Closest {
public:
    Closest(const Corners& a, const Corners& b) : a_(a), b_(b) { closest_.distance_squared = std::numeric_limits<double>::infinity(); }

    void vertex_of_a(int i) {
        if (is_behind(along_a_[i], most_of_b_)) return;
        const auto c = geometry::point_triangle_closest(a_.x.col(i), b_.x.col(0), b_.x.col(1), b_.x.col(2));
        if (!take(c, Primitive::vertex, i, Primitive::triangle, 0)) return;
        best_.point_a = a_.x.col(i);
        best_.point_b = -(b_.x * Vector3(c.weight[1], c.weight[2], c.weight[3]));
        best_.difference = c.difference;
        look_along(best_.difference);
    }
    void vertex_of_b(int j) {
        if (is_behind(least_of_a_, along_b_[j])) return;
        const auto c = geometry::point_triangle_closest(b_.x.col(j), a_.x.col(0), a_.x.col(1), a_.x.col(2));
        if (!take(c, Primitive::triangle, 0, Primitive::vertex, j)) return;
        best_.point_b = b_.x.col(j);
        best_.point_a = -(a_.x * Vector3(c.weight[1], c.weight[2], c.weight[3]));
        best_.difference = -c.difference;
        look_along(best_.difference);
    }
    // A vertex counts as an edge of length 0.
    void edges(Primitive kind_a, int i, Primitive kind_b, int j) {
        const int k = kind_a == Primitive::edge ? (i + 1) % 3 : i, l = kind_b == Primitive::edge ? (j + 1) % 3 : j;
        if (is_behind(std::min(along_a_[i], along_a_[k]), std::max(along_b_[j], along_b_[l]))) return;
        const Vector3 ea0 = a_.x.col(i), ea1 = kind_a == Primitive::edge ? edge_end(a_, i) : ea0;
        const Vector3 eb0 = b_.x.col(j), eb1 = kind_b == Primitive::edge ? edge_end(b_, j) : eb0;
        const auto c = geometry::edge_edge_closest(ea0, ea1, eb0, eb1);
        if (!take(c, kind_a, i, kind_b, j)) return;
        best_.point_a = c.weight[0] * ea0 + c.weight[1] * ea1;
        best_.point_b = -c.weight[2] * eb0 - c.weight[3] * eb1;
        best_.difference = c.difference;
        look_along(best_.difference);
    }
    // Features of the same elements elsewhere.
    void features_of(const ElementPairDistance& known) {
        if (known.kind_a == Primitive::triangle) return vertex_of_b(known.corner_b);
        if (known.kind_b == Primitive::triangle) return vertex_of_a(known.corner_a);
        edges(known.kind_a, known.corner_a, known.kind_b, known.corner_b);
    }
    // No others are closer, and the elements are apart.
    bool is_least() const { return least_of_a_ - most_of_b_ >= apart_; }
    ElementPairDistance result() {
        best_.distance = best_.difference.norm();
        return best_;
    }

private:
    bool take(const geometry::ClosestPoints& c, Primitive kind_a, int i, Primitive kind_b, int j) {
        if (!(c.distance_squared < closest_.distance_squared)) return false;
        closest_ = c;
        best_.kind_a = kind_a;
        best_.kind_b = kind_b;
        best_.corner_a = i;
        best_.corner_b = j;
        return true;
    }

    // n.x of all corners, n the direction of the difference.
    void look_along(const Vector3& difference) {
        const double distance = difference.norm();
        if (!(distance > 0)) {
            apart_ = std::numeric_limits<double>::infinity();
            return;
        }
        const Vector3 n = difference / distance;
        along_a_ = a_.x.transpose() * n;
        along_b_ = b_.x.transpose() * n;
        least_of_a_ = along_a_.minCoeff();
        most_of_b_ = along_b_.maxCoeff();
        apart_ = distance * (1 - 1e-13);
    }
    bool is_behind(double least_of_a, double most_of_b) const { return least_of_a - most_of_b >= apart_; }

    const Corners &a_, &b_;
    Vector3 along_a_ = Vector3::Zero(), along_b_ = Vector3::Zero();
    double least_of_a_ = 0, most_of_b_ = 0;
    double apart_ = std::numeric_limits<double>::infinity();
    geometry::ClosestPoints closest_;
    ElementPairDistance best_;
};

}  // namespace

ElementPairDistance element_pair_distance(const Corners& a, const Corners& b, const ElementPairDistance* before) {
    Closest closest(a, b);
    if (before != nullptr) {
        closest.features_of(*before);
        if (closest.is_least()) return closest.result();
    }
    if (b.count == 3)
        for (int i = 0; i < a.count; ++i) closest.vertex_of_a(i);
    if (a.count == 3)
        for (int j = 0; j < b.count; ++j) closest.vertex_of_b(j);
    if (a.count > 1 && b.count > 1) {
        for (int i = 0; i < edge_count(a); ++i)
            for (int j = 0; j < edge_count(b); ++j) closest.edges(Primitive::edge, i, Primitive::edge, j);
    } else if (a.count < 3 && b.count < 3) {
        closest.edges(a.count == 1 ? Primitive::vertex : Primitive::edge, 0, b.count == 1 ? Primitive::vertex : Primitive::edge, 0);
    }
    ElementPairDistance best = closest.result();
    if (!separates(best, a, b)) look_for_piercing(a, b, best);
    return best;
}

}  // namespace fettle::core::clearance
