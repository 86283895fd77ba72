// SPDX-License-Identifier: MIT
#include "core/clearance/hull_direction.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

#include "core/clearance/simplex.hpp"

namespace fettle::core::clearance {
namespace {

constexpr int most_rounds = 32;
constexpr int most_elements_in_turn = 16;  // without a look at boxes

double reach(const Piece& piece, const Vector3& direction) {
    return direction.dot(piece.center) + (piece.axes.transpose() * direction).cwiseAbs().dot(piece.half_extent);
}

Support value_of(const PieceElement& element, int corner, const Vector3& direction) {
    return {&element, corner, direction.dot(element.corners.x.col(corner))};
}

struct SupportDescent {
    const PieceTree& tree;
    const Vector3& direction;
    Support best;

    void take(const PieceElement& element) {
        const Matrix3& x = element.corners.x;  // whose last columns repeat a corner where there are fewer than three
        const double along[] = {direction.dot(x.col(0)), direction.dot(x.col(1)), direction.dot(x.col(2))};
        if (!(std::max({along[0], along[1], along[2]}) > best.value)) return;
        for (int k = 0; k < element.corners.count; ++k)
            if (along[k] > best.value) best = {&element, k, along[k]};
    }
    // What is no number is not left out.
    void visit(int index, double reaches) {
        if (reaches <= best.value) return;
        const Piece& piece = tree.pieces[index];
        if (piece.is_element()) {
            take(tree.elements[piece.first]);
            return;
        }
        const double left = reach(tree.pieces[piece.left], direction);
        const double right = reach(tree.pieces[piece.right], direction);
        if (left < right) {
            visit(piece.right, right);
            visit(piece.left, left);
        } else {
            visit(piece.left, left);
            visit(piece.right, right);
        }
    }
};

}  // namespace

Support support(const PieceTree& tree, const Vector3& direction, const Support& guess, int piece) {
    const Piece& root = tree.pieces[piece];
    SupportDescent descent{tree, direction, value_of(*guess.element, guess.corner, direction)};
    if (root.count <= most_elements_in_turn) {
        for (int i = root.first; i < root.first + root.count; ++i) descent.take(tree.elements[i]);
    } else {
        descent.visit(piece, reach(root, direction));
    }
    return descent.best;
}

HullDirection::HullDirection(const PieceTree& a, const PieceTree& b, int piece_a, int piece_b)
    : a_(a), b_(b), piece_a_(piece_a), piece_b_(piece_b) {
    simplex_[0] = {any_support(a, piece_a), any_support(b, piece_b), Vector3::Zero()};
}

// To the vertices that hold the point nearest to the origin, which is returned.
Vector3 HullDirection::reduce() {
    std::array<Vector3, 4> points;
    for (int i = 0; i < count_; ++i) points[i] = simplex_[i].difference;
    const SimplexPoint nearest = nearest_to_origin(points, count_);
    int kept = 0;
    for (int i = 0; i < count_; ++i)
        if (nearest.weight[i] > 0) simplex_[kept++] = simplex_[i];
    count_ = std::max(kept, 1);  // none where four hold the origin
    return nearest.point;
}

HullDirection::Bound HullDirection::at(const RelativePose& pose, double tolerance) {
    for (int i = 0; i < count_; ++i) {
        Vertex& vertex = simplex_[i];
        vertex.difference = pose.rotation * vertex.a.point() + pose.offset - vertex.b.point();
    }
    return approach(pose, [tolerance](double nearest, double apart) { return !(nearest - apart > tolerance); });
}

HullDirection::Bound HullDirection::beyond(const RelativePose& pose, const Vector3& n, double distance) {
    count_ = 1;
    simplex_[0] = furthest(pose, n, simplex_[0]);
    return approach(
        pose, [distance](double nearest, double apart) { return !(nearest > distance) || apart - distance > 0.5 * (nearest - distance); });
}

// What of a lies furthest back along n, and of b furthest along it.
HullDirection::Vertex HullDirection::furthest(const RelativePose& pose, const Vector3& n, const Vertex& guess) const {
    const Support a = support(a_, -(pose.rotation.transpose() * n), guess.a, piece_a_), b = support(b_, n, guess.b, piece_b_);
    return {a, b, pose.rotation * a.point() + pose.offset - b.point()};
}

// `is_done`: of the distance of the nearest points so far, which are no nearer than the hulls, and of the best bound.
template <class IsDone>
HullDirection::Bound HullDirection::approach(const RelativePose& pose, const IsDone& is_done) {
    Bound best;
    for (int round = 0; round < most_rounds; ++round) {
        const Vector3 nearest = reduce();
        const Vector3 n = unit_direction(nearest);
        if (n.isZero(0)) return best;  // four points hold the origin, or some touch it
        const Vertex next = furthest(pose, n, simplex_[0]);
        const double apart = n.dot(pose.offset) - next.a.value - next.b.value;
        if (apart > best.apart) best = {n, apart};
        if (is_done(nearest.norm(), best.apart)) return best;
        for (int i = 0; i < count_; ++i) {
            const Vertex& known = simplex_[i];
            if (known.a.point() == next.a.point() && known.b.point() == next.b.point()) return best;
        }
        simplex_[count_++] = next;
    }
    return best;
}

}  // namespace fettle::core::clearance
