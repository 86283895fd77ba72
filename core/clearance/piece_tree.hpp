// SPDX-License-Identifier: MIT
/// What the search for clearances splits a body into: boxes in the body's frame, halved down to single elements. The order of elements
/// and the upper boxes are those of the body's hierarchy (geometry/body_hierarchy.hpp), whose leaves hold several elements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/clearance/element_pair.hpp"
#include "core/geometry/body_hierarchy.hpp"

namespace fettle::core::clearance {

/// Larger pieces have boxes along the body's axes.
inline constexpr int most_elements_of_turned_box = 128;

/// Elements first .. first + count - 1 of the tree; a single element is a leaf. Children are disjoint and follow each other.
/// Boxes of small pieces follow the principal axes of their corners where that makes them smaller: a piece of a smooth surface is much
/// thinner along its normal than along any axis of the body.
struct Piece {
    Vector3 center = Vector3::Zero();       ///< of the box, in the body's frame
    Matrix3 axes = Matrix3::Identity();     ///< of the box: columns, orthonormal up to rounding
    Vector3 half_extent = Vector3::Zero();  ///< along them, rounded outwards
    double radius = 0;                      ///< upper bound of |X| over the piece
    double size = 0;                        ///< |half_extent|
    int left = -1, right = -1;
    int first = 0, count = 0;
    bool is_element() const { return left < 0; }
};

struct PieceElement {
    Corners corners;
    std::array<int, 3> vertices{-1, -1, -1};
    int primitive = -1;  ///< triangle, loose edge or loose point: its index into mesh.triangles, mesh.edges or the vertices
};

struct PieceTree {
    const geometry::Mesh* mesh = nullptr;
    std::vector<Piece> pieces;  ///< root is 0; in preorder
    std::vector<PieceElement> elements;
    double radius() const { return pieces[0].radius; }
    std::span<const PieceElement> elements_of(const Piece& piece) const {
        return {elements.data() + piece.first, static_cast<std::size_t>(piece.count)};
    }
};

/// `mesh` must outlive the tree; `hierarchy` is that of the mesh.
PieceTree make_piece_tree(const geometry::Mesh& mesh, const geometry::BodyHierarchy& hierarchy);

}  // namespace fettle::core::clearance
