// SPDX-License-Identifier: MIT
#include "fettle/core/clearance/hull_direction.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

#include "fettle/core/geometry/distance.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int most_rounds = 32;

double reach(const Piece& piece, const Vector3& direction) {
    return direction.dot(piece.center) + (piece.axes.transpose() * direction).cwiseAbs().dot(piece.half_extent);
}

Support value_of(const PieceElement& element, int corner, const Vector3& direction) {
    return {&element, corner, direction.dot(element.corners.x.col(corner))};
}

struct Descent {
    const PieceTree& tree;
    const Vector3& direction;
    Support best;

    // What is no number is not left out.
    void visit(int index, double reaches) {
        if (reaches <= best.value) return;
        const Piece& piece = tree.pieces[static_cast<std::size_t>(index)];
        if (piece.is_element()) {
            const PieceElement& element = tree.elements[static_cast<std::size_t>(piece.first)];
            for (int k = 0; k < element.corners.count; ++k) {
                const Support here = value_of(element, k, direction);
                if (here.value > best.value) best = here;
            }
            return;
        }
        const double left = reach(tree.pieces[static_cast<std::size_t>(piece.left)], direction);
        const double right = reach(tree.pieces[static_cast<std::size_t>(piece.right)], direction);
        if (left < right) {
            visit(piece.right, right);
            visit(piece.left, left);
        } else {
            visit(piece.left, left);
            visit(piece.right, right);
        }
    }
};

// The point of the simplex of `points` that is nearest to the origin, and the weights of the points; of four, zero if they hold it.
struct Nearest {
    Vector3 point = Vector3::Zero();
    std::array<double, 4> weight{};
};

Nearest nearest_of(const std::array<Vector3, 4>& x, int count) {
    Nearest nearest;
    if (count == 1) {
        nearest.point = x[0];
        nearest.weight[0] = 1;
        return nearest;
    }
    // Of fewer than three the last one is repeated.
    const auto of_triangle = [&](int i, int j, int k) {
        const geometry::ClosestPoints closest = geometry::point_triangle_closest(
            Vector3::Zero(), x[static_cast<std::size_t>(i)], x[static_cast<std::size_t>(j)], x[static_cast<std::size_t>(k)]);
        Nearest found;
        found.point = -closest.difference;
        found.weight[static_cast<std::size_t>(i)] -= closest.weight[1];
        found.weight[static_cast<std::size_t>(j)] -= closest.weight[2];
        found.weight[static_cast<std::size_t>(k)] -= closest.weight[3];
        return found;
    };
    if (count <= 3) return of_triangle(0, 1, count - 1);
    bool outside = false;
    double least = 0;
    for (const auto& [i, j, k, other] : {std::array{0, 1, 2, 3}, std::array{0, 1, 3, 2}, std::array{0, 2, 3, 1}, std::array{1, 2, 3, 0}}) {
        const Vector3& origin = x[static_cast<std::size_t>(i)];
        const Vector3 normal = (x[static_cast<std::size_t>(j)] - origin).cross(x[static_cast<std::size_t>(k)] - origin);
        const double inside = normal.dot(x[static_cast<std::size_t>(other)] - origin);
        if (normal.dot(-origin) * inside > 0) continue;
        const Nearest found = of_triangle(i, j, k);
        const double squared = found.point.squaredNorm();
        if (outside && !(squared < least)) continue;
        outside = true;
        least = squared;
        nearest = found;
    }
    return nearest;
}

}  // namespace

Support support(const PieceTree& tree, const Vector3& direction, const Support& guess) {
    Descent descent{tree, direction, value_of(*guess.element, guess.corner, direction)};
    descent.visit(0, reach(tree.pieces[0], direction));
    return descent.best;
}

HullDirection::HullDirection(const PieceTree& a, const PieceTree& b) : a_(a), b_(b) {
    simplex_[0] = {any_support(a), any_support(b), Vector3::Zero()};
}

// To the vertices that hold the point nearest to the origin, which is returned.
Vector3 HullDirection::reduce() {
    std::array<Vector3, 4> points;
    for (int i = 0; i < count_; ++i) points[static_cast<std::size_t>(i)] = simplex_[static_cast<std::size_t>(i)].difference;
    const Nearest nearest = nearest_of(points, count_);
    int kept = 0;
    for (int i = 0; i < count_; ++i)
        if (nearest.weight[static_cast<std::size_t>(i)] > 0)
            simplex_[static_cast<std::size_t>(kept++)] = simplex_[static_cast<std::size_t>(i)];
    count_ = std::max(kept, 1);
    return nearest.point;
}

HullDirection::Bound HullDirection::at(const RelativePose& pose, double tolerance) {
    for (int i = 0; i < count_; ++i) {
        Vertex& vertex = simplex_[static_cast<std::size_t>(i)];
        vertex.difference = pose.rotation * vertex.a.point() + pose.offset - vertex.b.point();
    }
    Bound best;
    for (int round = 0; round < most_rounds; ++round) {
        const Vector3 nearest = reduce();
        const Vector3 n = unit_direction(nearest);
        if (n.isZero(0) || count_ == 4) return best;
        const Support a = support(a_, -(pose.rotation.transpose() * n), simplex_[0].a), b = support(b_, n, simplex_[0].b);
        const double apart = n.dot(pose.offset) - a.value - b.value;
        if (apart > best.apart) best = {n, apart};
        if (!(nearest.norm() - best.apart > tolerance)) return best;
        for (int i = 0; i < count_; ++i) {
            const Vertex& known = simplex_[static_cast<std::size_t>(i)];
            if (known.a.point() == a.point() && known.b.point() == b.point()) return best;
        }
        simplex_[static_cast<std::size_t>(count_++)] = {a, b, pose.rotation * a.point() + pose.offset - b.point()};
    }
    return best;
}

}  // namespace fettle::core::clearance
