// SPDX-License-Identifier: MIT
/// Does a simulation start from a legal configuration? Intersections are decided exactly, on the world positions as rounded.
#pragma once

#include <optional>

#include "fettle/core/base/result.hpp"
#include "fettle/core/model/model.hpp"

namespace fettle::core::model {

/// For every pair of bodies that may collide: no two elements intersect or touch, none come as close as dmin (judged in floating point),
/// and neither body lies wholly inside the other's material.
/// @return one bodies_intersect error per pair at fault, which names the bodies, two elements (the first intersecting ones found, else the
///         closest) and a place in world coordinates, in the model's length_unit. Order: by pair of bodies; the same for any machine.
/// Contract: hierarchies built.
base::Errors check_start(const Model& model);

/// The same of one pair, whether the model lets it collide or not; nothing if there is no fault.
std::optional<base::Error> check_start_pair(const Model& model, int a, int b);

}  // namespace fettle::core::model
