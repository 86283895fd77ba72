// SPDX-License-Identifier: MIT
/// How far the arc of a turning arm leaves its chord: the parts of chord_deviation (curved_ccd.hpp) that need no translation.
/// The arm's end is x(s) = R(theta + s w) Y, s in [0, 1], and bounds are of |x(s) - ((1 - s) x(0) + s x(1))|.
///
/// Bounds, for exact arithmetic (docs/method/collision.md#curved-paths):
///   B0 = |w|^2 |Y| / 8,   because |x''| <= |w|^2 |Y|;
///   B1 = |w| (|w x Y| + |theta x w| |Y| / 3) / 8: x'' = 2 int e^{aM} w x (e^{bM} (w x e^{cM} Y)) over a + b + c = 1, M = [theta + s w],
///        and |w x e^{cM} Y| = |e^{-cM} w x Y| <= |w x Y| + c |theta x w| |Y|, with c of mean 1/3;
///   B3 = |x(1/2) - (x(0) + x(1))/2| + |w|^3 |Y| / (72 sqrt 3): the parabola through the three points, and the remainder of
///        cubic interpolation with |x'''| <= |w|^3 |Y|.
/// Rounding, u = 2^-53. Products and norms carry relative errors below 16 u: all is multiplied by 1 + 32 u. Cross products cancel: their
/// absolute error is at most 2u |a||b| per component, charged as 8u |a||b|. For B3 each evaluated x carries rotated_rounding.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/interval.hpp"
#include "core/kinematics/path.hpp"

namespace fettle::core::ccd {

/// Least of B0 and B1.
double arc_deviation(const Vector3& theta, const Vector3& w, const Vector3& Y);

/// B3 (three rotations).
double arc_deviation_cubic(const Vector3& theta, const Vector3& w, const Vector3& Y);

/// A box of rotation vectors and the coefficients of its rotations: sinc(x), 1/2 sinc(x/2)^2.
struct IntervalTurn {
    geometry::Interval3 theta;
    geometry::Interval a, b;
};

/// The paper's bound: distance of the box of the arc, by interval arithmetic over R(theta + [0, 1] w), to the box of the chord.
/// First order in |w|; infinite if something overflows. What does not depend on the arm is worked out once.
class IntervalArc {
public:
    IntervalArc(const Vector3& theta, const Vector3& w);
    double deviation(const Vector3& Y) const;

private:
    IntervalTurn start_, end_, during_;
};

/// The same for one arm.
double arc_deviation_interval(const Vector3& theta, const Vector3& w, const Vector3& Y);

/// Bound of |computed - exact| for rotation(theta + s w) * (base * X), |X| <= radius and base orthonormal to 1e-6, s <= s_end in [0, 1]:
///   u radius (80 + 4 |theta| + 6 s_end |w|).
/// Parts, times radius: rounding of theta + s w, at most u (s|w| + |theta + s w|), since R is 1-Lipschitz; of |theta|^2 and its square
/// root, 2.5u relative, so 2.5u |theta + s w| in the angle; sine, cosine (1 ulp) and the sums and products of the entries, 44u; products
/// with base and X, 6u each, their sum with a translation 1u of its size (charged by the caller), and headroom.
double rotated_rounding(double theta_norm, double w_norm, double s_end, double radius);

enum class DeviationBound { closed_form, interval };

/// Upper bound (rounding included) of |curve(s) - chord(s)| at equal parameter over the whole segment, for body point X:
/// the least of B0, B1, B3 (closed form), or the paper's interval bound without what it charges for translation.
double chord_deviation(const kinematics::PathSegment& segment, const Vector3& X, DeviationBound bound = DeviationBound::closed_form);

}  // namespace fettle::core::ccd
