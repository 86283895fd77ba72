// SPDX-License-Identifier: MIT
#include "core/features/resize.hpp"

#include "core/base/contract.hpp"
#include "core/features/handled_mesh.hpp"

namespace fettle::core::features {

base::Result<geometry::Mesh> resized(const geometry::Mesh& mesh, const Features& features, const std::vector<Resize>& changes) {
    std::vector<Handle> handles;
    for (const Resize& change : changes) {
        const std::string& name = features.features[change.feature].name;
        handles.push_back({.name = name, .kind = HandleKind::radius, .features = {name}});
    }
    const auto part = HandledMesh::create(mesh, features, handles);
    if (!part) return part.errors();
    std::vector<double> values;
    for (std::size_t k = 0; k < changes.size(); ++k) {
        const Feature& feature = features.features[changes[k].feature];
        const double facets = feature.is_hole ? feature.facets_least : feature.facets_largest;
        FETTLE_ASSERT(facets > 0 && facets + changes[k].by > 0, "a round feature with a radius keeps one");
        values.push_back(part->drawn_value(k) * (1 + changes[k].by / facets));
    }
    return part->at(values);
}

}  // namespace fettle::core::features
