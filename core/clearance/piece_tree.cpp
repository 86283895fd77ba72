// SPDX-License-Identifier: MIT
#include "core/clearance/piece_tree.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"

namespace fettle::core::clearance {
namespace {

class Builder {
public:
    Builder(PieceTree& tree, const geometry::BodyHierarchy& hierarchy) : tree_(tree), hierarchy_(hierarchy) {}

    int add_node(int index) {
        const geometry::HierarchyNode& node = hierarchy_.nodes()[index];
        Piece box;
        box.center = node.center;
        box.half_extent = node.half_extent;
        box.radius = node.radius;
        box.first = node.first;
        box.count = node.count;
        const int piece = start(box);
        if (node.is_leaf()) {
            if (node.count > 1) halve(piece);
            return piece;
        }
        const int left = add_node(node.left), right = add_node(node.right);
        tree_.pieces[piece].left = left;
        tree_.pieces[piece].right = right;
        return piece;
    }

    // Once all pieces are there: what they hold does not depend on their boxes.
    void finish() {
        constexpr int pieces_at_once = 64;  // that a thread takes
        base::parallel_for(count_of(tree_.pieces), pieces_at_once, [&](int i) {
            Piece& piece = tree_.pieces[i];
            if (piece.count <= most_elements_of_turned_box) turn_box(piece);
            piece.size = piece.half_extent.norm();
        });
    }

private:
    int start(const Piece& piece) {
        tree_.pieces.push_back(piece);
        return count_of(tree_.pieces) - 1;
    }

    // By the covariance of the corners; kept if the faces of the new box are smaller.
    void turn_box(Piece& piece) const {
        Vector3 sum = Vector3::Zero();
        int count = 0;
        for_corners(piece, [&](const Vector3& y) { sum += y, ++count; });
        const Vector3 mean = sum / count;
        Matrix3 covariance = Matrix3::Zero();
        for_corners(piece, [&](const Vector3& y) { covariance += (y - mean) * (y - mean).transpose(); });
        Eigen::SelfAdjointEigenSolver<Matrix3> solver;
        solver.computeDirect(covariance);
        Matrix3 axes = solver.eigenvectors();
        axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
        axes.col(1) = axes.col(2).cross(axes.col(0)).normalized();
        axes.col(0).normalize();
        if (solver.info() != Eigen::Success || !axes.allFinite()) return;
        Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for_corners(piece, [&](const Vector3& y) {
            const Vector3 along = axes.transpose() * y;
            low = low.cwiseMin(along);
            high = high.cwiseMax(along);
        });
        // Rounding of y is relative to |X|, all the rest to |y|.
        const double rounding = 16 * std::numeric_limits<double>::epsilon() * (piece.radius + piece.half_extent.norm());
        const Vector3 half = (0.5 * (high - low)).array() + rounding;
        const auto faces = [](const Vector3& e) { return e.x() * e.y() + e.y() * e.z() + e.z() * e.x(); };
        if (!(faces(half) < 0.9 * faces(piece.half_extent))) return;
        piece.center += axes * (0.5 * (high + low));
        piece.axes = axes;
        piece.half_extent = half;
    }

    // Corners of the piece's elements, from its center.
    template <class Visit>
    void for_corners(const Piece& piece, const Visit& visit) const {
        for (int i = piece.first; i < piece.first + piece.count; ++i)
            for (int k = 0; k < tree_.elements[i].corners.count; ++k) visit(Vector3(tree_.elements[i].corners.x.col(k) - piece.center));
    }

    void halve(int piece) {
        const int first = tree_.pieces[piece].first, count = tree_.pieces[piece].count;
        const int left = add_range(first, count / 2), right = add_range(first + count / 2, count - count / 2);
        tree_.pieces[piece].left = left;
        tree_.pieces[piece].right = right;
    }

    int add_range(int first, int count) {
        Vector3 low = tree_.elements[first].corners.x.col(0), high = low;
        double squared = 0;
        for (int i = first; i < first + count; ++i) {
            const Matrix3& x = tree_.elements[i].corners.x;
            low = low.cwiseMin(x.rowwise().minCoeff());
            high = high.cwiseMax(x.rowwise().maxCoeff());
            squared = std::max(squared, x.colwise().squaredNorm().maxCoeff());
        }
        constexpr double outwards = 1 + 4 * std::numeric_limits<double>::epsilon();
        Piece piece;
        piece.center = 0.5 * (low + high);
        for (int k = 0; k < 3; ++k) {
            const double half = std::max(high[k] - piece.center[k], piece.center[k] - low[k]);
            piece.half_extent[k] = half * outwards;  // the differences are exact or round by less than that
        }
        piece.radius = std::sqrt(squared) * outwards;
        piece.first = first;
        piece.count = count;
        const int index = start(piece);
        if (count > 1) halve(index);
        return index;
    }

    PieceTree& tree_;
    const geometry::BodyHierarchy& hierarchy_;
};

}  // namespace

PieceTree make_piece_tree(const geometry::Mesh& mesh, const geometry::BodyHierarchy& hierarchy) {
    PieceTree tree;
    tree.mesh = &mesh;
    for (const geometry::HierarchyElement& e : hierarchy.elements()) {
        PieceElement element;
        element.vertices = e.vertices;
        element.corners.count = e.vertex_count;
        for (int k = 0; k < 3; ++k) element.corners.x.col(k) = mesh.vertices.col(e.vertices[std::min(k, e.vertex_count - 1)]);
        element.primitive = e.vertex_count == 3 ? e.triangle : e.vertex_count == 2 ? e.owned_edges[0] : e.vertices[0];
        tree.elements.push_back(element);
    }
    tree.pieces.reserve(2 * tree.elements.size());
    Builder builder(tree, hierarchy);
    builder.add_node(0);
    builder.finish();
    return tree;
}

}  // namespace fettle::core::clearance
