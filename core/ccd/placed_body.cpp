// SPDX-License-Identifier: MIT
#include "fettle/core/ccd/placed_body.hpp"

namespace fettle::core::ccd {

void PlacedBody::start(const SweptBody& body, const std::array<Vector3, 2>& origin, const geometry::FlatFeatures* plane) {
    for (const PlacedElement& e : elements_) element_at_[e.element] = -1;
    for (const int v : placed_vertices_) vertex_at_[v] = -1;
    elements_.clear();
    details_.clear();
    vertices_.clear();
    placed_vertices_.clear();
    body_ = &body;
    plane_ = plane;
    origin_ = origin;
    const std::size_t elements = body.body->hierarchy->elements().size();
    const auto vertices = static_cast<std::size_t>(body.body->mesh.vertices.cols());
    if (element_at_.size() < elements) element_at_.resize(elements, -1);
    if (vertex_at_.size() < vertices) vertex_at_.resize(vertices, -1);
}

int PlacedBody::place_vertex(int vertex) {
    int& at = vertex_at_[vertex];
    if (at >= 0) return at;
    at = count_of(vertices_);
    placed_vertices_.push_back(vertex);
    PlacedVertex& out = vertices_.emplace_back();
    const auto X = body_->body->mesh.vertices.col(vertex);
    Eigen::Map<Vector3> start(out.x.data()), end(out.x.data() + 3);
    start = body_->ends[0].rotation * X + origin_[0];
    end = body_->ends[1].rotation * X + origin_[1];
    for (std::size_t k = 0; k < 3; ++k) {
        out.box.low[k] = std::min(out.x[k], out.x[k + 3]);
        out.box.minus_high[k] = -std::max(out.x[k], out.x[k + 3]);
    }
    return at;
}

int PlacedBody::place_element(int element) {
    const geometry::BodyHierarchy& hierarchy = *body_->body->hierarchy;
    const geometry::HierarchyElement& e = hierarchy.elements()[element];
    PlacedElement& out = elements_.emplace_back();
    out.element = element;
    const geometry::Triangle& face = hierarchy.faces()[e.face];
    for (int k = 0; k < 3; ++k) out.corners[k] = place_vertex(face[k]);
    out.box = vertices_[out.corners[0]].box;
    for (int k = 1; k < e.vertex_count; ++k) out.box = out.box.joined(vertices_[out.corners[k]].box);
    return count_of(elements_) - 1;
}

int PlacedBody::make_details(int i) {
    PlacedElement& element = elements_[i];
    element.details = count_of(details_);
    PlacedDetails& out = details_.emplace_back();
    const geometry::HierarchyElement& e = body_->body->hierarchy->elements()[element.element];
    const auto start = [&](int k) { return Eigen::Map<const Vector3>(vertices_[element.corners[k]].x.data()); };
    out.normal = (start(1) - start(0)).cross(start(2) - start(0));
    const double length = out.normal.norm();
    out.normal = length > 0 ? Vector3(out.normal * ((1 - 1e-14) / length)) : Vector3(Vector3::Zero());
    for (int k = 0; k < e.owned_edge_count; ++k) {
        if (plane_ != nullptr && plane_->is_plane_edge(e.owned_edges[k])) continue;
        PlacedEdge& edge = out.edges[out.edge_count++];
        edge.edge = e.owned_edges[k];
        edge.ends = {element.corners[e.owned_edge_corners[k][0]], element.corners[e.owned_edge_corners[k][1]]};
        edge.box = vertices_[edge.ends[0]].box.joined(vertices_[edge.ends[1]].box);
    }
    return element.details;
}

}  // namespace fettle::core::ccd
