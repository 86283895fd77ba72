// SPDX-License-Identifier: MIT
/// Continuous collision detection of primitives of two rigid bodies on curved paths: the curve of each vertex is replaced by its
/// chord, the deviation is charged to the minimum separation, and linear_ccd.hpp decides. docs/method/collision.md#curved-paths.
///
/// From time s, proven to be clear so far, take the rest of the segment if its deviation is at most 3/4 of the gap (lower bound of the
/// distance less dmin), else a piece whose deviation is at most 1/8 of it. The linear query with dmin + deviation + rounding either clears
/// the piece or says up to when it is clear: go on from there. A hit is reported once the gap is at most
/// min(linear.tolerance, a tenth of the first gap), when nothing can be proven any more, or past max_pieces.
/// Pairs that cannot meet are dismissed at once: first gap > |dq_a - dq_b| + |w_a| r_a + |w_b| r_b.
///
/// Rounding. World positions are taken relative to body b's reference point (differences of positions, so the world's origin does not
/// matter), and each computed vertex is within rotated_rounding (chord_deviation.hpp) + u (4 |q| + 8 |dq|) of the exact path. Both
/// bodies' bounds are charged twice: once for the ends of the chord, once for the rounded piece whose deviation is bounded.
/// For |theta| = 4e5 rad at radius 1 that is 4e-10.
///
/// The closed form of a piece of length h is h^2 times one rate (the least of B0 and B1 over the whole segment, for the vertex where that
/// is largest) wherever the piece starts: (theta + s w) x w = theta x w. B3 takes three rotations a piece and has not paid here.
///
/// Measured (tests/benchmarks/ccd_benchmark, one thread): wrecking-ball 0.26 us a query by the closed form, 4.7 us by the interval bound,
/// none reported; kinematic 2.4 us and, out of pieces, 1.7 ms; random pairs that pass closely 0.18 and 1.4 us. Hence the default.
#pragma once

#include <array>

#include "core/ccd/chord_deviation.hpp"
#include "core/ccd/linear_ccd.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::ccd {

struct CurvedCcdOptions {
    DeviationBound deviation = DeviationBound::closed_form;
    LinearCcdOptions linear;
    int max_pieces = 1024;  ///< of the bisection in time; past it the answer is a conservative hit
};

struct CurvedCcdResult {
    bool hit = false;  ///< may come within dmin; false is a proof that it does not
    double toi = 1;    ///< proven: distance > dmin on [0, toi)
};

/// `X`: the pair's vertices in their bodies' frames. point_triangle: X[0] on body a, X[1..3] on body b; edge_edge: X[0..1] on a,
/// X[2..3] on b. Contract: dmin >= 0.
CurvedCcdResult curved_ccd(geometry::PairType type, const kinematics::PathSegment& a, const kinematics::PathSegment& b,
                           const geometry::PairVertices& X, double dmin, const CurvedCcdOptions& options = {});

}  // namespace fettle::core::ccd
