// SPDX-License-Identifier: MIT
/// Planes, cylinders, cones, spheres and tori in a mesh (docs/method/features.md):
///
///     const core::features::Features found = core::features::find_features(mesh);
///     for (const auto& feature : found.features) std::printf("%s: r %g m\n", feature.name.c_str(), feature.surface.radius);
///
/// Names depend on where things are, not on the order of vertices and triangles: B1 is the bore whose middle comes first by x, then y, then
/// z, in steps of 10 um.
#pragma once

#include <optional>

#include "core/features/feature.hpp"
#include "core/geometry/mesh.hpp"

namespace fettle::core::features {

struct FeatureOptions {
    /// How far corners may lie from their surface [m]. Nothing: as near as the digits of files are, 2e-6 of the size and 1.2e-5 of the
    /// largest coordinate; or 6e-5 of the size, where that explains most of what is left over: a mesh that is not exact.
    std::optional<double> tolerance{};
    /// The most that two neighbouring facets of one surface lean against each other [rad]: a circle of 10 sides is round, one of 9 is a
    /// polygon.
    double largest_step = 0.637;
};

/// Contract: coordinates are finite, connectivity is built.
Features find_features(const geometry::Mesh& mesh, const FeatureOptions& options = {});

}  // namespace fettle::core::features
