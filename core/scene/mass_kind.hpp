// SPDX-License-Identifier: MIT
/// Mass of a mesh by what its density is per (scene.hpp, MassKind).
#pragma once

#include <optional>

#include "core/scene/scene.hpp"

namespace fettle::core::scene {

/// Moments (geometry/mass_moments.hpp) with unit density: of the solid, openings capped; of the triangles; of all edges; of all vertices.
Matrix4 unit_moments(const geometry::Mesh& mesh, MassKind kind);

/// [m], in the mesh's frame. nullopt if the mesh has no such mass: for a volume, if it is not nearly closed or the volume is 0.
std::optional<Vector3> centre_of_mass(const geometry::Mesh& mesh, MassKind kind);

/// The same from the moments; nullopt if there is no mass.
std::optional<Vector3> centre_of_mass(const Matrix4& moments);

/// "kg/m^3", "kg/m^2", "kg/m", "kg".
const char* density_unit(MassKind kind);

}  // namespace fettle::core::scene
