// SPDX-License-Identifier: MIT
/// Round features of a mesh made larger or smaller: the corners of a bore, a pin, a ball or its socket move away from the axis or the
/// centre, all by the same share of their distance, so that facets stay facets. Everything else stays bit for bit.
///
///     const std::vector<Resize> changes{{.feature = features.find("B1"), .by = 0.1e-3}};
///     const auto wider = core::features::resized(mesh, features, changes);
///     if (!wider) return 3;  // a face that would bend, a triangle that would turn over, a wall that would be cut through
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.hpp"
#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

struct Resize {
    int feature = 0;
    double by = 0;  ///< [m] what the facets' own radius grows by: of holes facets_least, of bosses facets_largest
};

/// A corner that also belongs to a flat face must stay in it, one of another round face on that, to within the features' tolerance. A cone
/// beside it on the same axis that ends at flat faces, a chamfer or a countersink, moves along; other faces on the axis may change their
/// slope, but not lean the other way. Triangles may not turn over, and the surface may not pass through
/// itself. Errors (mesh_invalid, inconsistent), with `where` the feature's name and, in the message, the place.
/// Contract: features of this mesh, cylinders and spheres, whose radius stays positive; each once.
base::Result<geometry::Mesh> resized(const geometry::Mesh& mesh, const Features& features, const std::vector<Resize>& changes);

/// The least thickness of material behind a feature's facets, along their normals from corners and middles: measured at these, not proven.
/// Nothing: no ray meets another face. Contract: connectivity is built.
struct Wall {
    double thickness = 0;             ///< [m]
    Vector3 place = Vector3::Zero();  ///< on the feature
};
std::optional<Wall> wall_behind(const geometry::Mesh& mesh, const Feature& feature);

}  // namespace fettle::core::features
