// SPDX-License-Identifier: MIT
/// Continuous collision detection of primitives of two rigid bodies on curved paths: the curve of each vertex is replaced by its
/// chord, the deviation is charged to the minimum separation, and linear_ccd.hpp decides. method.md section 7.
#pragma once

#include <array>

#include "fettle/core/contact/linear_ccd.hpp"
#include "fettle/core/kinematics/path.hpp"

namespace fettle::core::contact {

enum class DeviationBound { closed_form, interval };

/// Upper bound (rounding included) of |curve(s) - chord(s)| at equal parameter over the whole segment, for body point X:
/// the least of B0, B1, B3 (closed form), or the paper's interval bound.
double chord_deviation(const kinematics::PathSegment& segment, const Vector3& X, DeviationBound bound = DeviationBound::closed_form);

struct CurvedCcdOptions {
    DeviationBound deviation = DeviationBound::closed_form;
    LinearCcdOptions linear;
    int max_pieces = 1024;   ///< of the bisection in time; past it the answer is a conservative hit
};

struct CurvedCcdResult {
    bool hit = false;   ///< may come within dmin; false is a proof that it does not
    double toi = 1;     ///< proven: distance > dmin on [0, toi)
};

/// `X`: the pair's vertices in their bodies' frames. point_triangle: X[0] on body a, X[1..3] on body b; edge_edge: X[0..1] on a,
/// X[2..3] on b. Contract: dmin >= 0.
CurvedCcdResult curved_ccd(PairType type, const kinematics::PathSegment& a, const kinematics::PathSegment& b, const PairVertices& X,
                           double dmin, const CurvedCcdOptions& options = {});

}  // namespace fettle::core::contact
