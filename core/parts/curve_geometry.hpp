// SPDX-License-Identifier: MIT
/// What is asked of one curve (curve.hpp), whichever kind it is. Each runs over u from 0 at its start to 1 at its end: lines and arcs
/// evenly, Beziers in their own parameter, laws evenly in theirs. Questions that decide are answered on plain numbers, the rest is
/// recorded.
#pragma once

#include <optional>

#include "core/parts/curve.hpp"

namespace fettle::core::parts {

/// On plain numbers: nothing of it is recorded. Laws stay as they are.
Curve frozen(const Curve& curve);

struct CurvePoint {
    Vector2 position, velocity;  ///< velocity: d position / du
};
CurvePoint at(const Curve& curve, double u);
/// d2 position / du2 at u, on plain numbers.
Vector2 bending(const Curve& curve, double u);

Point2 point_at(const Curve& curve, const Number& u);
/// d point / du.
Point2 tangent_at(const Curve& curve, const Number& u);

/// Whether it is the whole circle.
bool is_whole_circle(const Arc& arc);
/// Angle that the arc turns by, positive counter-clockwise, 0 < |sweep| <= 2 pi.
Number sweep_of(const Arc& arc);

/// Whether neither line nor arc.
bool is_general(const Curve& curve);
/// Sum of the angles that it turns by, left or right [rad]; of general curves from samples.
double turning(const Curve& curve);
/// Number of even steps in u that follow it: each turns by some 10 degrees or less. 1 for lines.
int sample_count(const Curve& curve);
/// Some length of it, from samples [m]: 0 only if it is a point.
double sampled_length(const Curve& curve);

/// A box that holds it; of general curves by samples and a margin.
struct Box2 {
    Vector2 low, high;
    bool meets(const Box2& b) const { return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all(); }
};
Box2 box_of(const Curve& curve);

/// u of the point of the curve that is nearest to p; of general curves from samples, then refined.
double nearest_parameter(const Curve& curve, const Vector2& p);
double distance_to(const Curve& curve, const Vector2& p);
/// u, recorded, of a point that is on the curve at u0: exact to first order.
Number parameter_of(const Curve& curve, const Point2& on_curve, double u0);

Curve reversed(const Curve& curve);

/// Where a curve is cut: u, recorded (general curves only need it), and the point.
struct Cut {
    double u = 0;
    Number parameter = 0;
    Point2 point;
};
/// The part from one cut to a later one. A whole circle goes from a cut on round to `to`, whose u may exceed 1.
Curve between(const Curve& curve, const Cut& from, const Cut& to);

/// The curve at a distance to its left (right if negative); nothing if an arc has no radius left. Its u is that of the curve.
std::optional<Curve> beside(const Curve& curve, const Number& distance);

/// Moves in the plane, turned and mirrored: x -> columns x + shift.
struct Placement2 {
    Point2 column_x{1, 0}, column_y{0, 1}, shift;
    bool mirrors = false;
};
Point2 placed(const Point2& p, const Placement2& placement);
Curve placed(const Curve& curve, const Placement2& placement);

/// The angle by which an arc turns [rad], positive counter-clockwise; +-2 pi of a whole circle.
double sweep_value(const Arc& arc);

/// Number of straight pieces that a curve is drawn with.
int facet_count(const Curve& curve, const Facets& facets);

/// A curve as straight pieces; the material is to its left.
struct Chain {
    std::vector<Point2> inner;  ///< between its start and its end
    bool through_start = true;  ///< false: a whole circle whose vertices are `inner` alone
    double out = 0, in = 0;     ///< the curve is so far to the right (outside), to the left of the chain [m]
    bool proven = true;
};
Chain chain_of(const Curve& curve, int count, Lean lean);

}  // namespace fettle::core::parts
