// SPDX-License-Identifier: MIT
/// The curves that profiles are made of. Each is run through from its start to its end; ends are points of their own, which neighbours
/// share. How curves are drawn one after another: path.hpp.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/range.hpp"
#include "core/parts/facets.hpp"
#include "core/parts/jet.hpp"
#include "core/parts/point.hpp"

namespace fettle::core::parts {

struct Line {
    Point2 start, end;
};

/// About `centre` from start to end, which lie on the circle; the whole circle where they are the same point.
struct Arc {
    Point2 start, end;
    Point2 centre;
    Number radius;                  ///< > 0
    bool counter_clockwise = true;  ///< seen with x to the right and y up
};

/// A cubic by its four control points (of a B-spline each span is one).
struct Bezier {
    std::array<Point2, 4> points;
};

/// A point of a curve as a function of its parameter, made of any function object that can be called with a parameter of any kind of
/// number and returns two of that kind:
///     Law([&](const auto& t) { return std::array{radius * cos(t), radius * sin(t) + rise * t}; })
/// It may hold dimensions (Number), and must give the same for the same parameter.
struct Law {
    std::function<std::array<Number, 2>(const Number&)> point;
    std::function<std::array<Jet<Number>, 2>(const Jet<Number>&)> jet;
    std::function<std::array<Jet<double>, 2>(const Jet<double>&)> bend;
    /// Over a stretch of the parameter; and with more derivatives, which an offset needs.
    std::function<std::array<Jet<geometry::Range>, 2>(const Jet<geometry::Range>&)> ranges;
    std::function<std::array<Jet<Jet<geometry::Range>>, 2>(const Jet<Jet<geometry::Range>>&)> higher_ranges;

    Law() = default;
    template <class Function>
    explicit Law(Function f) {
        const auto shared = std::make_shared<const Function>(std::move(f));
        point = [shared](const Number& t) { return (*shared)(t); };
        jet = [shared](const Jet<Number>& t) { return (*shared)(t); };
        bend = [shared](const Jet<double>& t) { return (*shared)(t); };
        ranges = [shared](const Jet<geometry::Range>& t) { return (*shared)(t); };
        higher_ranges = [shared](const Jet<Jet<geometry::Range>>& t) { return (*shared)(t); };
    }

    /// Bound over a range of the parameter of the second derivative's part that is square to a chord within the range [m / parameter^2],
    /// where there is a closed form: a chord over the step h leaves the curve by an eighth of it times h^2, at most. Else the law is
    /// evaluated on ranges (law_chords.hpp).
    std::function<double(double from, double to)> largest_bend;
    bool turns_one_way = false;  ///< promises that it has no inflection

    /// Where this one runs at a distance to the left of another (profile_booleans.hpp, offset).
    std::shared_ptr<const Law> offset_of;
    Number offset_distance = 0;
};

/// A part of a law's curve: parameters from `from` to `to`, which may fall.
struct LawCurve {
    std::shared_ptr<const Law> law;
    Number from, to;
    Point2 start, end;  ///< the points there, or the neighbours' that agree with them
};

using Curve = std::variant<Line, Arc, Bezier, LawCurve>;

/// One curve of a loop.
struct Segment {
    Curve curve;
    std::string feature;           ///< the designer's name for what it bounds: "rim", "slot 2"; for messages and surfaces
    std::optional<Facets> facets;  ///< how it becomes a polygon, if not as the drawing says
};

const Point2& start_of(const Curve& curve);
const Point2& end_of(const Curve& curve);

/// Involute of the circle of radius `base` about the origin, at the roll angle u:
///     base (cos(u + turn) + u sin(u + turn), sin(u + turn) - u cos(u + turn)),  at distance base sqrt(1 + u^2) from the origin.
/// @param mirrored  The other hand: u counts clockwise, the point at u = 0 stays at the angle `turn`.
/// With u from 0 on it leaves the circle at right angles.
LawCurve involute(const Number& base, const Number& turn, const Number& from, const Number& to, bool mirrored = false);

/// From `from` to `to` (rising or falling) along the law.
LawCurve law_curve(Law law, const Number& from, const Number& to);

/// Natural cubic spline through the points (second derivative zero at the ends), or closed through the first point again, as one cubic per
/// interval; parameters by the square roots of chord lengths (centripetal). Contract: at least 2 points (3 closed),
/// neighbours differ.
std::vector<Bezier> spline_through(const std::vector<Point2>& points, bool closed = false);

/// Uniform cubic B-spline of the control points, as one cubic per span. Open: begins at the first and ends at the last control point (these
/// count three times); closed: none of them is on the curve in general. Contract: at least 2 (3 closed) points.
std::vector<Bezier> b_spline(const std::vector<Point2>& control_points, bool closed = false);

}  // namespace fettle::core::parts
