// SPDX-License-Identifier: MIT
/// What a search for candidates looks at of a body, each placed once: vertices at both ends of the segment, and boxes as both bodies of the
/// pair see them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/ccd/four_separations.hpp"
#include "core/ccd/placed_box.hpp"
#include "core/ccd/swept_pair.hpp"

namespace fettle::core::ccd {

struct PlacedVertex {
    SweptVertex x;
    PlacedBox box;
};

class PlacedBody {
public:
    /// Forgets what was placed, in the time that it took to place it.
    /// @param is_first  is it body a of the pair?
    /// @param origin    what the positions of SweptVertex are relative to, at each end
    void start(const SweptBody& body, const SeenMotion& seen, bool is_first, const std::array<Vector3, 2>& origin);

    /// Number of a vertex of the mesh among those placed, which now it is.
    int place(int vertex) {
        int& at = vertex_at_[vertex];
        return at >= 0 ? at : at = place_vertex(vertex);
    }
    const PlacedVertex& vertex(int i) const { return vertices_[i]; }
    const geometry::BodyHierarchy& hierarchy() const { return *body_->body->hierarchy; }
    const geometry::Mesh& mesh() const { return body_->body->mesh; }
    /// Places an axis-aligned box in the body's frame whose points are within `radius`.
    void place_box(const geometry::HierarchyNode& node, PlacedBox& out) const;
    void place_box(const geometry::OwnedBox& box, double radius, PlacedBox& out) const;
    /// Sum of the box's edges in the body's own frame, [m].
    float size_of(const PlacedBox& box) const {
        float size = 0;
        for (std::size_t k = own_; k < own_ + 3; ++k) size -= box.low[k] + box.minus_high[k];
        return size;
    }

private:
    /// Columns of a rotation and an offset, four numbers each.
    using Placing = std::array<std::array<double, 4>, 4>;
    static Placing placing(const Matrix3& rotation, const Vector3& offset);

    int place_vertex(int vertex);

    const SweptBody* body_ = nullptr;
    std::size_t own_ = 0;                   ///< the body's own axes among the numbers of a PlacedBox
    SeenMotion loss_;                       ///< of its points, as the other body sees them
    std::array<Placing, 2> seen_, placed_;  ///< at each end: in the other body's frame; along the world's axes
    std::vector<int> vertex_at_;            ///< [vertex] among those placed; -1: not placed
    std::vector<PlacedVertex> vertices_;
    std::vector<int> placed_vertices_;  ///< their numbers in the body
};

}  // namespace fettle::core::ccd
