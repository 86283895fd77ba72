// SPDX-License-Identifier: MIT
#include "core/clearance/faces_alone.hpp"

#include <memory>

#include "core/base/contract.hpp"

namespace fettle::core::clearance {

namespace {

geometry::SubMesh reduce(const FacesOfBody& faces, model::Model& model) {
    if (faces.triangles.empty()) return {};
    model::Body& body = model.bodies[faces.body];
    geometry::SubMesh part = geometry::sub_mesh(body.mesh, faces.triangles);
    body.mesh = part.mesh;
    body.hierarchy = std::make_shared<const geometry::BodyHierarchy>(body.mesh);
    body.mass_kind = scene::MassKind::area;  // a sheet
    body.mass_kind_given = true;
    body.round = nullptr;
    return part;
}

int primitive_in_whole(const geometry::SubMesh& part, Primitive kind, int primitive) {
    if (part.triangles.empty() || primitive < 0) return primitive;
    if (kind == Primitive::vertex) return part.vertices[primitive];
    return (kind == Primitive::edge ? part.edges : part.triangles)[primitive];
}

}  // namespace

FacesAlone::FacesAlone(const model::Model& model, const FacesOfBody& a, const FacesOfBody& b) : model_(model) {
    FETTLE_ASSERT(a.body != b.body, "faces of two bodies");
    a_ = reduce(a, model_);
    b_ = reduce(b, model_);
}

Witness FacesAlone::in_whole(Witness witness) const {
    witness.primitive_a = primitive_in_whole(a_, witness.kind_a, witness.primitive_a);
    witness.primitive_b = primitive_in_whole(b_, witness.kind_b, witness.primitive_b);
    return witness;
}

PairClearance FacesAlone::in_whole(PairClearance pair) const {
    pair.witness = in_whole(pair.witness);
    for (Witness& witness : pair.witnesses) witness = in_whole(witness);
    return pair;
}

}  // namespace fettle::core::clearance
