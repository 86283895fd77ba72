// SPDX-License-Identifier: MIT
#include "core/ccd/placed_tree.hpp"

#include <limits>

namespace fettle::core::ccd {

using geometry::HierarchyElement;
using geometry::HierarchyNode;

void PlacedTree::start(PlacedBody& body, PrimitiveKind kind, int node, const geometry::FlatFeatures* plane) {
    body_ = &body;
    kind_ = kind;
    plane_ = plane;
    items_.clear();
    add_node(node);
}

void PlacedTree::make_children(int i) {
    const int first = count_of(items_);
    const std::vector<HierarchyNode>& nodes = body_->hierarchy().nodes();
    const HierarchyNode& node = nodes[items_[i].node];
    if (node.is_leaf()) {
        add_primitives(items_[i].node);
    } else {
        // Four at a time where there are: half as many to place, and to look at.
        for (const int child : {node.left, node.right}) {
            const HierarchyNode& half = nodes[child];
            if (half.is_leaf())
                add_primitives(child);
            else if (nodes[half.left].is_leaf() || nodes[half.right].is_leaf())
                add_node(child);
            else
                for (const int quarter : {half.left, half.right}) add_node(quarter);
        }
    }
    items_[i].first = first;
    items_[i].count = count_of(items_) - first;
}

void PlacedTree::add_node(int i) {
    const geometry::BodyHierarchy& hierarchy = body_->hierarchy();
    const HierarchyNode& node = hierarchy.nodes()[i];
    const std::vector<geometry::OwnedBox>* owned = kind_ == PrimitiveKind::vertices                     ? &hierarchy.vertex_boxes()
                                                   : kind_ == PrimitiveKind::edges && plane_ != nullptr ? &hierarchy.edge_boxes()
                                                                                                        : nullptr;
    const bool has_own = owned != nullptr && !owned->empty();
    if (has_own && (*owned)[i].is_empty()) {
        if (!items_.empty()) return;
        PlacedItem& nothing = items_.emplace_back();  // is split before all else
        nothing.node = i;
        nothing.first = 0;
        nothing.size = std::numeric_limits<float>::infinity();
        return;
    }
    PlacedItem& item = items_.emplace_back();
    if (has_own)
        body_->place_box((*owned)[i], node.radius, item.box);
    else
        body_->place_box(node, item.box);
    item.size = body_->size_of(item.box);
    item.radius = node.radius;
    item.node = i;
}

void PlacedTree::add_primitive(int primitive, int element, double radius, const std::array<int, 3>& vertices) {
    PlacedItem& item = items_.emplace_back();
    item.box = body_->vertex(vertices[0]).box;
    for (const int v : {vertices[1], vertices[2]})
        if (v != vertices[0]) item.box.join(body_->vertex(v).box);
    item.size = body_->size_of(item.box);
    item.radius = radius;
    item.primitive = primitive;
    item.element = element;
    item.vertex = vertices;
}

void PlacedTree::add_primitives(int i) {
    const geometry::BodyHierarchy& hierarchy = body_->hierarchy();
    const HierarchyNode& leaf = hierarchy.nodes()[i];
    for (int e = leaf.first; e < leaf.first + leaf.count; ++e) {
        const HierarchyElement& element = hierarchy.elements()[e];
        switch (kind_) {
            case PrimitiveKind::vertices:
                for (int k = 0; k < element.owned_vertex_count; ++k) {
                    const int v = body_->place(element.owned_vertices[k]);
                    add_primitive(element.owned_vertices[k], e, leaf.radius, {v, v, v});
                }
                break;
            case PrimitiveKind::faces: {
                const geometry::Triangle& face = hierarchy.faces()[element.face];
                add_primitive(e, e, leaf.radius, {body_->place(face[0]), body_->place(face[1]), body_->place(face[2])});
                break;
            }
            case PrimitiveKind::edges:
                for (int k = 0; k < element.owned_edge_count; ++k) {
                    const int edge = element.owned_edges[k];
                    if (plane_ != nullptr && plane_->is_plane_edge(edge)) continue;
                    const geometry::Edge& ends = body_->mesh().edges[edge];
                    const int first = body_->place(ends[0]), last = body_->place(ends[1]);
                    add_primitive(edge, e, leaf.radius, {first, last, last});
                }
                break;
        }
    }
}

}  // namespace fettle::core::ccd
