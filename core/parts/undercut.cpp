// SPDX-License-Identifier: MIT
#include "core/parts/undercut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.hpp"
#include "core/parts/curve_geometry.hpp"

namespace fettle::core::parts {
namespace {

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

// By which a tangent turns to the left until it is another.
double turn_between(const Vector2& from, const Vector2& to) { return std::atan2(cross(from, to), from.dot(to)); }

struct Bend {
    double curvature = 0;  ///< towards the side that is looked at [1/m]
    Vector2 place = Vector2::Zero();
};

void take(Bend& sharpest, double curvature, const Vector2& place) {
    if (curvature > sharpest.curvature) sharpest = {curvature, place};
}

struct Place {
    double u = 0;
    CurvePoint point;
    double curvature = 0;  ///< to the left [1/m]; 0 where there is no direction
};

Place place_at(const Curve& curve, double u) {
    Place out{u, at(curve, u), 0};
    const double speed = out.point.velocity.norm();
    if (speed > 0) out.curvature = cross(out.point.velocity, bending(curve, u)) / (speed * speed * speed);
    return out;
}

// Between two places: more than at both, where the curve turns more than they say. There it is halved, towards the half that turns more:
// at a kink the curvature grows with each half.
Bend bend_between(const Curve& curve, Place from, Place to, int side) {
    constexpr int most_halves = 20;
    constexpr double alike = 1.1;
    Bend out;
    for (int k = 0; k <= most_halves; ++k) {
        take(out, side * from.curvature, from.point.position);
        take(out, side * to.curvature, to.point.position);
        const double turn = side * turn_between(from.point.velocity, to.point.velocity),
                     length = (to.point.position - from.point.position).norm();
        if (!(turn > alike * length * std::max({side * from.curvature, side * to.curvature, 0.0}))) break;
        if (k == most_halves) take(out, turn / length, to.point.position);
        const Place middle = place_at(curve, (from.u + to.u) / 2);
        const bool is_first = side * turn_between(from.point.velocity, middle.point.velocity) > turn / 2;
        (is_first ? to : from) = middle;
    }
    return out;
}

// The sharpest bend of a curve, towards its left (side 1) or right (side -1).
Bend sharpest_bend(const Curve& curve, int side) {
    Bend out;
    if (std::holds_alternative<Line>(curve)) return out;
    const int steps = std::holds_alternative<Arc>(curve) ? 1 : std::max(64, 4 * sample_count(curve));
    Place before = place_at(curve, 0);
    take(out, side * before.curvature, before.point.position);
    for (int k = 1; k <= steps; ++k) {
        const Place here = place_at(curve, static_cast<double>(k) / steps);
        take(out, side * here.curvature, here.point.position);
        if (steps > 1) {
            const Bend sharper = bend_between(curve, before, here, side);
            take(out, sharper.curvature, sharper.place);
        }
        before = here;
    }
    return out;
}

Error undercut(const Segment& segment, const Bend& bend, double distance) {
    const double angle = std::atan2(bend.place.y(), bend.place.x());
    const auto millimetres = [](double metres) { return format_length(metres, "mm", 3); };
    const std::string name = segment.feature.empty() ? "a curve without a name" : "`" + segment.feature + "`";
    const std::string bends =
        std::isinf(bend.curvature) ? "there is a corner" : "there it bends with a radius of " + millimetres(1 / bend.curvature);
    return {ErrorCode::inconsistent, segment.feature,
            name + " is undercut at " + format_quantity(angle < 0 ? angle + 2 * std::numbers::pi : angle, "deg", 4) + ", (" +
                millimetres(bend.place.x()) + ", " + millimetres(bend.place.y()) + "): " + bends + ", the offset is " +
                millimetres(std::abs(distance))};
}

}  // namespace

Errors undercuts(const Profile& profile, double distance) {
    constexpr double rounding = 1e-9, least_corner = 1e-6;  // of the curvature; [rad]
    Errors out;
    const int side = distance < 0 ? 1 : -1;  // the material is to the left
    for (const Loop& loop : profile.loops) {
        const std::size_t n = loop.segments.size();
        for (std::size_t k = 0; k < n; ++k) {
            const Segment& segment = loop.segments[k];
            Bend sharpest = sharpest_bend(segment.curve, side);
            const CurvePoint end = at(segment.curve, 1), next = at(loop.segments[(k + 1) % n].curve, 0);
            if (side * turn_between(end.velocity, next.velocity) > least_corner) sharpest = {INFINITY, end.position};
            if (sharpest.curvature * std::abs(distance) > 1 + rounding) out.push_back(undercut(segment, sharpest, distance));
        }
    }
    return out;
}

}  // namespace fettle::core::parts
