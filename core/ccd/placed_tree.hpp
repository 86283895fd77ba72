// SPDX-License-Identifier: MIT
/// The tree of a body's vertices, faces or edges for a search between two bodies (placed_body.hpp). It grows where the search gets to:
/// nodes of the body's hierarchy with boxes of what they hold of that kind, and below the last ones the primitives themselves.
#pragma once

#include <array>
#include <vector>

#include "core/ccd/placed_body.hpp"

namespace fettle::core::ccd {

enum class PrimitiveKind { vertices, faces, edges };

struct PlacedItem {
    PlacedBox box;
    double radius = 0;            ///< its points' are within, [m]
    float size = 0;               ///< of the box
    int node = -1;                ///< of the hierarchy; -1: a primitive
    int first = -1, count = 0;    ///< children; -1: not made yet
    int primitive = -1;           ///< vertex or edge of the mesh, element of the hierarchy
    int element = -1;             ///< that owns it
    std::array<int, 3> vertex{};  ///< its corners among the body's placed ones: of faces that are edges or points repeated to three
    bool is_primitive() const { return node < 0; }
};

class PlacedTree {
public:
    /// Begins at a node of the body's hierarchy, which item 0 is.
    /// @param plane  whose plane edges are left out; null: none are
    void start(PlacedBody& body, PrimitiveKind kind, int node, const geometry::FlatFeatures* plane);

    const PlacedItem& operator[](int i) const { return items_[i]; }
    /// Makes the children of an item that is no primitive, unless they are there.
    void expand(int i) {
        if (items_[i].first < 0) make_children(i);
    }

private:
    void make_children(int i);
    void add_node(int node);
    void add_primitives(int node);
    void add_primitive(int primitive, int element, double radius, const std::array<int, 3>& vertices);

    PlacedBody* body_ = nullptr;
    PrimitiveKind kind_ = PrimitiveKind::faces;
    const geometry::FlatFeatures* plane_ = nullptr;
    std::vector<PlacedItem> items_;
};

}  // namespace fettle::core::ccd
