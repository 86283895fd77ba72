// SPDX-License-Identifier: MIT
/// Which triangles stand round each vertex, and the proof that those round one vertex meet in their shared edges only: what spares a mesh
/// check the tests of neighbours, which are most of all pairs whose boxes overlap.
#pragma once

#include <vector>

#include "core/geometry/mesh.hpp"

namespace fettle::core::solids {

/// Corners (3 t + k) of triangles by vertex, in order.
class VertexCorners {
public:
    /// Contract: vertex indices in range.
    explicit VertexCorners(const geometry::Mesh& mesh);

    const int* begin(int vertex) const { return corners_.data() + first_[vertex]; }
    const int* end(int vertex) const { return corners_.data() + first_[static_cast<std::size_t>(vertex) + 1]; }

private:
    std::vector<int> first_, corners_;
};

/// A triangle round a vertex: it runs from the edge to one other vertex to the edge to the next, counter-clockwise seen from outside.
struct FanSector {
    int from, to;
};

/// Asks vertex after vertex of one mesh; for use by one thread. Both arguments outlive it.
class FanCheck {
public:
    FanCheck(const geometry::Mesh& mesh, const VertexCorners& corners) : mesh_(mesh), corners_(corners) {}

    /// True only if the triangles round the vertex close up once and no two of them have a point in common but the vertex and the edges
    /// that they share: there is a direction along which all of them are seen from the same side, and together they turn once round the
    /// vertex. Exact; false where this does not show it (a boundary, a saddle that is too steep, a vertex of two surfaces).
    /// Contract: finite coordinates.
    bool is_simple(int vertex);

private:
    const geometry::Mesh& mesh_;
    const VertexCorners& corners_;
    std::vector<FanSector> sectors_;  ///< of the vertex that is asked of
};

}  // namespace fettle::core::solids
