// SPDX-License-Identifier: MIT
/// Continuous collision detection of primitives whose vertices move on straight lines at constant speed, with a minimum
/// separation. Never misses, rounding included. Curved paths: curved_ccd.hpp.
#pragma once

#include <array>

#include "fettle/core/base/types.hpp"

namespace fettle::core::contact {

enum class PairType { point_triangle, edge_edge };

/// Vertices of a pair: point_triangle p t0 t1 t2, edge_edge ea0 ea1 eb0 eb1.
using PairVertices = std::array<Vector3, 4>;

enum class LinearCcdMethod { conservative_advancement, inclusion };

struct LinearCcdOptions {
    LinearCcdMethod method = LinearCcdMethod::conservative_advancement;
    double tolerance = 1e-6;     ///< inclusion: size of the boxes; advancement: fraction/absolute gap at which it reports a hit
    int max_iterations = 1'000'000;
};

struct LinearCcdResult {
    bool hit = false;   ///< may come within `dmin` in [0, 1]; false is a proof that it does not
    double toi = 1;     ///< proven: distance > dmin for all times in [0, toi)
};

/// Do the primitives come within `dmin` (>= 0) for some time in [0, 1], the vertices moving from `t0` to `t1`?
LinearCcdResult linear_ccd(PairType type, const PairVertices& t0, const PairVertices& t1, double dmin,
                           const LinearCcdOptions& options = {});

}  // namespace fettle::core::contact
