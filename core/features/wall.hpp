// SPDX-License-Identifier: MIT
/// How much material is behind a feature, measured.
#pragma once

#include <optional>

#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

/// The least thickness of material behind a feature's facets, along their normals from corners and middles: measured at these, not proven.
/// Nothing: no ray meets another face. Contract: connectivity is built.
struct Wall {
    double thickness = 0;             ///< [m]
    Vector3 place = Vector3::Zero();  ///< on the feature
};
std::optional<Wall> wall_behind(const geometry::Mesh& mesh, const Feature& feature);

}  // namespace fettle::core::features
