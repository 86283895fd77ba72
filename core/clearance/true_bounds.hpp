// SPDX-License-Identifier: MIT
/// What is known of the parts that meshes were drawn for, whose round surfaces are round: by how far the meshes are from them
/// (geometry::Deviation).
#pragma once

#include <optional>
#include <span>

#include "core/clearance/pair_clearance.hpp"
#include "core/model/model.hpp"

namespace fettle::core::clearance {

/// Bounds of a distance between parts whose round surfaces are round [m].
struct TrueBounds {
    double lower = 0, upper = 0;  ///< infinity: not measured
    bool lower_is_proven = false, upper_is_proven = false;
};

/// Bounds of the least distance of all these pairs of bodies. Nothing: neither side has such a mesh, or the meshes have no proven distance.
std::optional<TrueBounds> true_bounds(const model::Model& model, std::span<const PairClearance> members);
/// The same for two bodies. Nothing for bodies that touch or pass through each other, too.
std::optional<TrueBounds> true_bounds(const model::Model& model, const PairClearance& pair);

/// A measure of whether facets may be the cause of a clash: by how much those of the two parts reach beyond the round surfaces that they
/// stand for, together [m]. Meshes that are no deeper in each other than that may be of parts that are apart; finer facets tell.
std::optional<double> clash_of_facets(const model::Model& model, const PairClearance& pair);

}  // namespace fettle::core::clearance
