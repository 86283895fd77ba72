// SPDX-License-Identifier: MIT
#include "core/clearance/certificate_builder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/contract.hpp"
#include "core/geometry/distance.hpp"
#include "core/records/trajectory_io.hpp"

namespace fettle::core::clearance {
namespace {

certificate::BodyPieces body_pieces(const PieceTree& tree) {
    const auto triangles = count_of(tree.mesh->triangles), edges = count_of(tree.mesh->edges);
    certificate::BodyPieces body;
    for (const PieceElement& e : tree.elements) {
        const int offset = e.corners.count == 3 ? 0 : e.corners.count == 2 ? triangles : triangles + edges;
        body.elements.push_back(offset + e.primitive);
    }
    for (const Piece& piece : tree.pieces)
        if (!piece.is_element()) body.cuts.push_back(tree.pieces[piece.left].count);
    return body;
}

// Weights of a point of a primitive with corners x in its mesh's order: those of the closest point to it.
certificate::CertifiedPoint certified_point(const geometry::Mesh& mesh, Primitive kind, int index, const Vector3& X) {
    certificate::CertifiedPoint point{kind, index, {1, 0, 0}};
    if (kind == Primitive::edge) {
        const auto& e = mesh.edges[index];
        const auto closest = geometry::edge_edge_closest(X, X, mesh.vertices.col(e[0]), mesh.vertices.col(e[1]));
        point.weight = {-closest.weight[2], -closest.weight[3], 0};
    } else if (kind == Primitive::triangle) {
        const auto& t = mesh.triangles[index];
        const auto closest = geometry::point_triangle_closest(X, mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2]));
        point.weight = {-closest.weight[1], -closest.weight[2], -closest.weight[3]};
    }
    for (double& w : point.weight) w = std::max(w, 0.0);
    return point;
}

// Where an edge passes through a triangle the witness names the end next to it: the edge itself has the point.
void name_crossing_edge(const PieceTree& tree, int element, int corner, const Vector3& X, Primitive& kind, int& index) {
    const PieceElement& e = tree.elements[element];
    double nearest = std::numeric_limits<double>::infinity();
    for (const int k : {corner, (corner + 2) % 3}) {
        if (e.corners.count < 3 && k != 0) continue;
        const double d = geometry::edge_edge_distance_squared(X, X, e.corners.x.col(k), e.corners.x.col((k + 1) % 3));
        if (d >= nearest) continue;
        nearest = d;
        kind = Primitive::edge;
        index = primitive_index(tree, element, Primitive::edge, k);
    }
}

}  // namespace

certificate::Certificate start_certificate(const model::Model& model, const stepper::Trajectory& trajectory,
                                           const std::vector<const PieceTree*>& trees, bool motion, std::size_t pairs) {
    certificate::Certificate certificate;
    certificate.geometry_hash = records::geometry_hash(model);
    certificate.path_hash = records::path_hash(trajectory);
    certificate.length_unit = model.length_unit;
    certificate.motion = motion;
    for (const PieceTree* tree : trees) certificate.bodies.push_back(tree != nullptr ? body_pieces(*tree) : certificate::BodyPieces{});
    certificate.pairs.resize(pairs);
    return certificate;
}

certificate::CertifiedPoint certified_witness(const PieceTree& tree, int element, bool intersecting, const ElementFeature& feature,
                                              const Vector3& X) {
    Primitive kind = feature.kind;
    int index = primitive_index(tree, element, kind, feature.corner);
    if (intersecting && kind == Primitive::vertex) name_crossing_edge(tree, element, feature.corner, X, kind, index);
    return certified_point(*tree.mesh, kind, index, X);
}

void complete_certificate(const PairMotion& pair, const SearchResult& found, certificate::PairCertificate& certificate) {
    const Encounter& nearest = found.nearest;
    const Witness witness = witness_of(pair, nearest);
    const Instant at = instant_at(pair.segments[nearest.segment], nearest.s);
    const Vector3 on_a = at.rotation_a.transpose() * (nearest.pair.point_a - at.offset),
                  on_b = at.rotation_b.transpose() * nearest.pair.point_b;
    certificate.lower = found.lower;
    certificate.upper = found.upper + 4 * pair.segments[nearest.segment].slack;  // for the checker's own rounding
    certificate.step = witness.step;
    certificate.segment = witness.segment;
    certificate.at = {witness.s};
    const ElementPairDistance& found_pair = nearest.pair;
    certificate.point_a =
        certified_witness(pair.a, nearest.element_a, found_pair.intersecting, {found_pair.kind_a, found_pair.corner_a}, on_a);
    certificate.point_b =
        certified_witness(pair.b, nearest.element_b, found_pair.intersecting, {found_pair.kind_b, found_pair.corner_b}, on_b);
    if (!(found.lower > 0)) certificate.boxes.clear();
}

std::vector<certificate::CertifiedBody> certified_bodies(const certificate::Certificate& certificate, const model::Model& model) {
    std::vector<certificate::CertifiedBody> bodies(model.bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (certificate.bodies[i].elements.empty()) continue;
        auto body = certificate::certified_body(certificate.bodies[i], model.bodies[i].mesh);
        FETTLE_ASSERT(body.has_value(), "pieces of our own that are wrong");
        bodies[i] = std::move(body).value();
    }
    return bodies;
}

void drop_unmeasured(certificate::Certificate& certificate) {
    std::erase_if(certificate.pairs, [](const auto& pair) { return !std::isfinite(pair.upper) || pair.point_a.index < 0; });
}

}  // namespace fettle::core::clearance
