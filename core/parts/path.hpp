// SPDX-License-Identifier: MIT
/// Draws a closed loop, one curve after another:
///     Result<Loop> link = Path({0, 0}, "link").line_to({a, 0}).round(r).line_to({a, b}).arc_to({0, b}, Bend{bulge}).chamfer(c).closed();
/// Each call goes on from where the last one ended. Faults are kept and told by closed().
#pragma once

#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/parts/curve.hpp"

namespace fettle::core::parts {

/// Closed: each segment starts where the one before ends (the same values), the first where the last ends.
struct Loop {
    std::vector<Segment> segments;
};

/// Distances to cut off on both sides of a corner, along its curves [m].
struct Corner {
    Number radius;         ///< > 0: rounded, tangent to both curves
    Number before, after;  ///< > 0: chamfered by a line
    std::string feature;   ///< of the new segment; empty: that of the curve before
};

class Path {
public:
    explicit Path(const Point2& start, std::string feature = {});

    /// What follows bounds this feature / becomes a polygon so.
    Path& feature(std::string name);
    Path& facets(const Facets& facets);

    Path& line_to(const Point2& end);
    /// Round `centre`, which is as far from the end as from the start (to 1e-9 of the radius, or it is a fault).
    Path& arc_about(const Point2& centre, const Point2& end, bool counter_clockwise = true);
    /// Through three points: where it is, `middle`, `end`. Fault: on one line.
    Path& arc_through(const Point2& middle, const Point2& end);
    /// Goes on in the direction in which the curve before ends. Fault: nothing before; straight on or straight back.
    Path& tangent_arc_to(const Point2& end);
    /// As in DXF: bulge = tan(a quarter of the arc's angle), positive counter-clockwise; 1 is a half circle. Fault: 0.
    Path& bulge_to(const Point2& end, const Number& bulge);
    /// From here round `centre` by `angle` (counter-clockwise if positive, less than a full turn).
    Path& arc_by(const Point2& centre, const Number& angle);
    /// Natural spline from here through the points.
    Path& spline_through(const std::vector<Point2>& points);
    /// B-spline whose first control point is here.
    Path& spline_by(const std::vector<Point2>& control_points);
    /// Along a law's curve, to which a line leads if it starts elsewhere (more than 1e-9 of its size away).
    Path& along(const LawCurve& curve);
    /// Segments of another path or loop, to which a line leads if they start elsewhere.
    Path& along(const std::vector<Segment>& segments);

    /// The corner here is rounded or chamfered, once the next curve is drawn (or the loop closed; called before any curve: the corner at
    /// the start). A corner without an angle is left as it is.
    Path& round(const Number& radius, std::string feature = {});
    Path& chamfer(const Number& distance, std::string feature = {});
    Path& chamfer(const Number& before, const Number& after, std::string feature = {});

    /// Closed by a line, if the last curve does not end at the start. Errors: the faults, `where` is the feature.
    Result<Loop> closed() const;
    /// The segments so far, without corners cut.
    const std::vector<Segment>& segments() const { return segments_; }
    Point2 end() const;

private:
    Path& add(Curve curve);

    Point2 start_;
    std::string feature_;
    std::optional<Facets> facets_;
    std::vector<Segment> segments_;
    std::vector<std::pair<std::size_t, Corner>> corners_;  ///< before which segment
    Errors faults_;
};

/// Common loops, counter-clockwise.
Loop circle(const Point2& centre, const Number& radius, std::string feature = {});
/// Sides along x and y, from its lower left corner.
Loop rectangle(const Point2& corner, const Number& width, const Number& height, std::string feature = {});
Loop polygon(const std::vector<Point2>& corners, std::string feature = {});
/// The outline of a slot or a link, with round ends about a and b. Contract: a and b differ, radius > 0.
Loop slot(const Point2& a, const Point2& b, const Number& radius, std::string feature = {});

/// Every corner of a loop rounded or chamfered alike, or those that `which` says.
enum class Corners { all, convex, concave };  ///< convex: where a loop that is run through counter-clockwise turns left
Result<Loop> rounded(const Loop& loop, const Number& radius, Corners which = Corners::all, std::string feature = {});
Result<Loop> chamfered(const Loop& loop, const Number& distance, Corners which = Corners::all, std::string feature = {});

}  // namespace fettle::core::parts
