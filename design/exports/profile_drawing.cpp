// SPDX-License-Identifier: MIT
#include "design/exports/profile_drawing.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>
#include <vector>

#include "core/parts/curve_geometry.hpp"

namespace fettle::design::exports {
namespace {

using core::parts::Arc;
using core::parts::Bezier;
using core::parts::Curve;
using core::parts::Loop;
using core::parts::Profile;

// Millimetres, to a nanometre; no "-0".
std::string in_millimetres(double metres) {
    const double value = std::round(metres * 1e9) / 1e6 + 0.0;
    char text[40];
    const auto [end, code] = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 6);
    std::string out(text, code == std::errc() ? end : text);
    out.erase(out.find_last_not_of('0') + 1);
    if (out.ends_with('.')) out.pop_back();
    return out;
}

Vector2 plain(const core::parts::Point2& p) { return {p.x.value, p.y.value}; }

// A point of a loop, and how the loop goes on from there: straight, or along an arc that turns by `sweep`.
struct Knot {
    Vector2 at;
    double sweep = 0;   // counter-clockwise positive
    double radius = 0;  // of the arc
};

// Lines and arcs. A whole circle alone is one knot with a sweep of a full turn.
std::vector<Knot> knots_of(const Loop& loop, double chord) {
    std::vector<Knot> knots;
    for (const auto& segment : loop.segments) {
        const Curve& curve = segment.curve;
        const Vector2 start = plain(start_of(curve));
        if (const auto* arc = std::get_if<Arc>(&curve)) {
            knots.push_back({start, sweep_of(*arc).value, arc->radius.value});
        } else if (!is_general(curve)) {
            knots.push_back({start});
        } else {
            core::parts::Facets facets;
            facets.chord = chord;
            const int count = std::max(1, facet_count(curve, facets));
            for (int k = 0; k < count; ++k) knots.push_back({k == 0 ? start : at(curve, static_cast<double>(k) / count).position});
        }
    }
    return knots;
}

bool is_circle(const std::vector<Knot>& knots) {
    return knots.size() == 1 && std::abs(std::abs(knots[0].sweep) - 2 * std::numbers::pi) < 1e-9;
}

Vector2 centre_of_circle(const Loop& loop) { return plain(std::get<Arc>(loop.segments.front().curve).centre); }

// Twice the signed area, arcs with their caps.
double turning_area(const std::vector<Knot>& knots) {
    double sum = 0;
    for (std::size_t k = 0; k < knots.size(); ++k) {
        const Vector2 &a = knots[k].at, &b = knots[(k + 1) % knots.size()].at;
        sum += a.x() * b.y() - a.y() * b.x();
        if (knots[k].sweep != 0) sum += knots[k].radius * knots[k].radius * (knots[k].sweep - std::sin(knots[k].sweep));
    }
    return sum;
}

void pair(std::string& text, int code, const std::string& value) { text += std::to_string(code) + "\n" + value + "\n"; }

// The box of a curve as it lies, with its extreme points.
struct Box {
    Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity()), high = -low;
    void add(const Vector2& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
};

Box box_of(const Profile& profile, double chord) {
    Box box;
    for (const Loop& loop : profile.loops) {
        for (const auto& segment : loop.segments) {
            const auto* arc = std::get_if<Arc>(&segment.curve);
            if (arc == nullptr) continue;
            const Vector2 centre = plain(arc->centre), from = plain(arc->start) - centre;
            const double start = std::atan2(from.y(), from.x()), sweep = sweep_of(*arc).value;
            for (int quarter = -8; quarter <= 8; ++quarter) {
                const double angle = quarter * std::numbers::pi / 2, along = (angle - start) / sweep;
                if (along >= 0 && along <= 1) box.add(centre + arc->radius.value * Vector2(std::cos(angle), std::sin(angle)));
            }
        }
        for (const Knot& knot : knots_of(loop, chord)) box.add(knot.at);
    }
    return box;
}

std::string svg_point(const Vector2& p) { return in_millimetres(p.x()) + " " + in_millimetres(-p.y()); }

std::string svg_arc(double radius, double sweep, const Vector2& end) {
    const bool is_large = std::abs(sweep) > std::numbers::pi;
    return "A" + in_millimetres(radius) + " " + in_millimetres(radius) + " 0 " + (is_large ? "1 " : "0 ") + (sweep > 0 ? "0 " : "1 ") +
           svg_point(end);
}

// One command for each curve; whole circles as two arcs, of which an end is not its start.
std::string svg_loop(const Loop& loop, double chord) {
    std::string path = "M" + svg_point(plain(start_of(loop.segments.front().curve)));
    for (const auto& segment : loop.segments) {
        const Curve& curve = segment.curve;
        const Vector2 end = plain(end_of(curve));
        if (const auto* arc = std::get_if<Arc>(&curve)) {
            const double sweep = sweep_of(*arc).value, radius = arc->radius.value;
            if (is_whole_circle(*arc)) {
                path += svg_arc(radius, sweep / 2, 2 * plain(arc->centre) - plain(arc->start));
                path += svg_arc(radius, sweep / 2, end);
            } else {
                path += svg_arc(radius, sweep, end);
            }
        } else if (const auto* bezier = std::get_if<Bezier>(&curve)) {
            path += "C" + svg_point(plain(bezier->points[1])) + " " + svg_point(plain(bezier->points[2])) + " " + svg_point(end);
        } else if (is_general(curve)) {
            core::parts::Facets facets;
            facets.chord = chord;
            const int count = std::max(1, facet_count(curve, facets));
            for (int k = 1; k < count; ++k) path += "L" + svg_point(at(curve, static_cast<double>(k) / count).position);
            path += "L" + svg_point(end);
        } else {
            path += "L" + svg_point(end);
        }
    }
    return path + "Z";
}

}  // namespace

std::string profile_dxf(const Profile& profile, double chord) {
    std::string text;
    pair(text, 999, "made by fettle, in millimetres");
    pair(text, 0, "SECTION");
    pair(text, 2, "HEADER");
    pair(text, 9, "$ACADVER");
    pair(text, 1, "AC1009");
    pair(text, 9, "$INSUNITS");
    pair(text, 70, "4");
    pair(text, 0, "ENDSEC");
    pair(text, 0, "SECTION");
    pair(text, 2, "ENTITIES");
    for (const Loop& loop : profile.loops) {
        const std::vector<Knot> knots = knots_of(loop, chord);
        if (knots.empty()) continue;
        const std::string layer = turning_area(knots) > 0 ? "outline" : "hole";
        if (is_circle(knots)) {
            const Vector2 centre = centre_of_circle(loop);
            pair(text, 0, "CIRCLE");
            pair(text, 8, layer);
            pair(text, 10, in_millimetres(centre.x()));
            pair(text, 20, in_millimetres(centre.y()));
            pair(text, 40, in_millimetres(knots[0].radius));
            continue;
        }
        pair(text, 0, "POLYLINE");
        pair(text, 8, layer);
        pair(text, 66, "1");
        pair(text, 70, "1");
        for (const Knot& knot : knots) {
            pair(text, 0, "VERTEX");
            pair(text, 8, layer);
            pair(text, 10, in_millimetres(knot.at.x()));
            pair(text, 20, in_millimetres(knot.at.y()));
            if (knot.sweep == 0) continue;
            char bulge[40];
            const auto [end, code] = std::to_chars(bulge, bulge + sizeof bulge, std::tan(knot.sweep / 4), std::chars_format::general, 15);
            pair(text, 42, std::string(bulge, code == std::errc() ? end : bulge));
        }
        pair(text, 0, "SEQEND");
    }
    pair(text, 0, "ENDSEC");
    pair(text, 0, "EOF");
    return text;
}

std::string profile_svg(const Profile& profile, double chord) {
    const Box box = box_of(profile, chord);
    const Vector2 size = box.high - box.low;
    std::string path;
    for (const Loop& loop : profile.loops)
        if (!loop.segments.empty()) path += svg_loop(loop, chord);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + in_millimetres(size.x()) + "mm\" height=\"" + in_millimetres(size.y()) +
           "mm\" viewBox=\"" + in_millimetres(box.low.x()) + " " + in_millimetres(-box.high.y()) + " " + in_millimetres(size.x()) + " " +
           in_millimetres(size.y()) + "\">\n<path fill=\"#d0d4da\" fill-rule=\"evenodd\" stroke=\"black\" stroke-width=\"0.1\" d=\"" +
           path + "\"/>\n</svg>\n";
}

}  // namespace fettle::design::exports
