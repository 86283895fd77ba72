// SPDX-License-Identifier: MIT
/// What of a body follows from its mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "core/model/model.hpp"

namespace fettle::core::model {

/// Fills radius (rounded up), edge_length_squared, areas and hierarchy from the body's mesh.
void complete_geometry(Body& body);

/// The same for all; bodies whose meshes have the same shape share one hierarchy.
void complete_geometry(std::vector<Body>& bodies);
/// @param first_of_shape  [body] the first with the same mesh (geometry::first_of_shape)
void complete_geometry(std::vector<Body>& bodies, const std::vector<std::size_t>& first_of_shape);

/// The body's mesh where it starts, in the order of its own triangles.
geometry::Mesh mesh_at_start(const Body& body);

}  // namespace fettle::core::model
