// SPDX-License-Identifier: MIT
#include "core/records/geometry_hash.hpp"

#include "core/files/hash.hpp"

namespace fettle::core::records {

std::uint64_t geometry_hash(const model::Model& model) {
    files::Fnv1a hash;
    for (const model::Body& body : model.bodies) {
        hash.add(static_cast<std::uint64_t>(body.name.size()));
        hash.add(body.name);
        hash.add(static_cast<std::uint64_t>(body.mesh.vertices.cols()));
        for (const double x : body.mesh.vertices.reshaped()) hash.add(x);
        hash.add(static_cast<std::uint64_t>(body.mesh.triangles.size()));
        for (const auto& triangle : body.mesh.triangles) {
            for (const int v : triangle) hash.add(static_cast<std::uint32_t>(v));
        }
        hash.add(static_cast<std::uint64_t>(body.mesh.edges.size()));
        for (const auto& edge : body.mesh.edges) {
            for (const int v : edge) hash.add(static_cast<std::uint32_t>(v));
        }
        if (body.mass_kind == scene::MassKind::volume) continue;
        hash.add(static_cast<std::uint64_t>(body.mass_kind));
        if (!body.mass_kind_given) hash.add(static_cast<std::uint64_t>(0));
    }
    return hash.value();
}

}  // namespace fettle::core::records
