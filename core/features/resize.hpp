// SPDX-License-Identifier: MIT
/// Round features of a mesh made larger or smaller by what their facets ask for: handles (handled_mesh.hpp) of one feature each.
///
///     const std::vector<Resize> changes{{.feature = features.find("B1"), .by = 0.1e-3}};
///     const auto wider = core::features::resized(mesh, features, changes);
///     if (!wider) return 3;  // a face that would bend, a triangle that would turn over, a wall that would be cut through
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

struct Resize {
    int feature = 0;
    double by = 0;  ///< [m] what the facets' own radius grows by: of holes facets_least, of bosses facets_largest
};

/// Errors: those of HandledMesh::at, with `where` the feature's name. Contract: features of this mesh, cylinders and spheres, whose radius
/// stays positive; each once.
base::Result<geometry::Mesh> resized(const geometry::Mesh& mesh, const Features& features, const std::vector<Resize>& changes);

}  // namespace fettle::core::features
