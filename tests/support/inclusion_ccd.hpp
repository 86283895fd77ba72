// SPDX-License-Identifier: MIT
/// Linear CCD by inclusion-based bisection over (t, u, v): the oracle of core/ccd/linear_ccd.hpp where exact arithmetic takes too long,
/// and what ccd_benchmark compares it with. Independent of it; measured on the public queries (one thread): 0 misses, 280 us a query on
/// sample-queries, 200 us on scalable, at most 0.14 s.
/// Source: Wang et al. 2021, A Large-Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision Detection.
///
/// Method. F(t, u, v), the difference of a point of each primitive, is linear in each of its three parameters, so the corner values of a
/// box in the unit cube bound it, axis by axis. A box whose values miss [-(err + dmin), err + dmin] on some axis holds no contact;
/// others are halved along the dimension that is widest against its tolerance, earliest time first. A box that reached its tolerance is
/// a hit at its first time: everything earlier has been excluded.
/// dmin is applied per axis, so a reported distance is within sqrt(3) (tolerance + dmin).
///
/// Rounding. u = 2^-53. Vertices are shifted to vertex 0 at t0 (relative error u per coordinate: half an ulp of the difference) and scaled
/// by the power of two that brings them to |x| <= 1 (exact), so that delta = 1 in the source's err = c delta^3. Directly, with |x| <= 1:
///   x_t = x_t0 + t (x_t1 - x_t0)      off by 2u + 2u + u = 5u
///   edge-edge      (a1 - a0) u + a0   off by (5 + 5 + 2) + 2 + 5 + 1 = 20u;   minus the same, + 2u:   42u
///   point-triangle (c1 - c0) u + (c2 - c0) v + c0   off by 14 + 14 + 4 + 5 + 5 = 42u;   minus p, + 5u + 6u:   53u
/// and the shift at most 4u (the weights 1 - u - v, u, v, 1 sum to 4 in absolute value at the corners). The code charges the source's
/// larger constant and 2 for the shift: err = 36 * 2^-52 = 72u for both.
#pragma once

#include "core/ccd/linear_ccd.hpp"

namespace fettle::tests::support {

/// As linear_ccd, but options.tolerance is the size of a box's image, so that hits are within sqrt(3) (tolerance + dmin), and past
/// options.max_iterations boxes the answer is a hit at the time proven so far.
core::ccd::LinearCcdResult inclusion_ccd(core::geometry::PairType type, const core::geometry::PairVertices& t0,
                                         const core::geometry::PairVertices& t1, double dmin,
                                         const core::ccd::LinearCcdOptions& options = {});

}  // namespace fettle::tests::support
