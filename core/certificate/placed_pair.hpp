// SPDX-License-Identifier: MIT
/// Two bodies over a box of coordinates and deviations, and bounds of their distance there (the formulas: toleranced_prover.hpp).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/certificate/pair_formulas.hpp"

namespace fettle::core::certificate {

/// Where the bodies are over a box of all variables.
struct PlacedPair {
    std::shared_ptr<const ModelledPair> models;
    ModelMatrix rotation;  ///< of a's frame as b's sees it
    Model3 place;
    std::vector<TaylorModel> positions;  ///< of the pair's coordinates, then its dependents
    bool is_known = true;                ///< false: a loop is not enclosed over the box
};

/// A lower bound of n.(x_a - x_b) over the box, in b's frame, for the vertices of two pieces; minus infinity where nothing is known.
double least_along(const PlacedPair& at, const Vector3& n, std::span<const int> a, std::span<const int> b);
/// The same of a vector that turns, for each pair of vertices, over max |n|.
double least_turning(const PlacedPair& at, const Model3& n, std::span<const int> a, std::span<const int> b);
/// n(t). @param vectors  n_0, then each variable's
Model3 turning_vector(std::span<const Vector3> vectors);

}  // namespace fettle::core::certificate
