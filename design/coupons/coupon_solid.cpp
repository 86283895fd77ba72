// SPDX-License-Identifier: MIT
#include "design/coupons/coupon_solid.hpp"

#include <algorithm>
#include <set>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "core/geometry/mass_moments.hpp"
#include "core/parts/drawn_part.hpp"
#include "core/parts/extrude.hpp"
#include "design/exports/profile_drawing.hpp"

namespace fettle::design::coupons {

namespace {

using namespace core::parts;
using tolerances::FeatureKind;

constexpr double chord = 2e-6;

Loop rectangle_of(const CouponFeature& feature, double x, double width) {
    return rectangle({x - width / 2, feature.y - feature.length / 2}, width, feature.length, feature.name);
}

Loop circle_of(const CouponFeature& feature) { return circle({feature.x, feature.y}, feature.nominal / 2, feature.name); }

// Holes and slots.
std::vector<Loop> openings(const Coupon& coupon) {
    std::vector<Loop> loops;
    for (const CouponFeature& feature : coupon.features) {
        if (feature.kind == FeatureKind::hole) loops.push_back(circle_of(feature));
        if (feature.kind == FeatureKind::slot) loops.push_back(rectangle_of(feature, feature.x, feature.nominal));
    }
    return loops;
}

// What of the plate's features is there above a height.
Result<Profile> standing_above(const Coupon& coupon, double height) {
    std::vector<Profile> figures;
    Errors errors;
    const auto add = [&](const Result<Profile>& figure) {
        if (figure) figures.push_back(*figure);
        errors.insert(errors.end(), figure.errors().begin(), figure.errors().end());
    };
    for (const CouponFeature& feature : coupon.features) {
        if (!(feature.height > height)) continue;
        if (feature.kind == FeatureKind::pin) add(filled(circle_of(feature)));
        if (feature.kind == FeatureKind::wall) add(filled(rectangle_of(feature, feature.x, feature.nominal)));
        if (feature.kind != FeatureKind::gap) continue;
        const double off = (feature.nominal + coupon.rib) / 2;
        add(filled(rectangle_of(feature, feature.x - off, coupon.rib)));
        add(filled(rectangle_of(feature, feature.x + off, coupon.rib)));
    }
    if (coupon.thickness + coupon.label_height > height)
        for (const CouponLabel& label : coupon.labels) add(label_profile(label.text, coupon.font, label.x, label.y));
    if (!errors.empty()) return errors;
    return together(figures);
}

Result<Profile> plate(const Coupon& coupon) {
    const Result<Profile> whole = filled(rectangle({0, 0}, coupon.width, coupon.depth, "plate"));
    if (!whole) return whole.errors();
    return with_holes(*whole, openings(coupon));
}

}  // namespace

Result<core::geometry::Mesh> coupon_mesh(const Coupon& coupon) {
    FETTLE_ASSERT(coupon.kind == CouponKind::printed, "a printed coupon");
    std::set<double> levels{coupon.thickness, coupon.thickness + coupon.label_height};
    for (const CouponFeature& feature : coupon.features)
        if (feature.height > coupon.thickness) levels.insert(feature.height);
    const Result<Profile> base = plate(coupon);
    if (!base) return base.errors();
    std::vector<Layer> layers{{*base, 0, coupon.thickness, {}, {}, "plate"}};
    for (auto level = levels.begin(); std::next(level) != levels.end(); ++level) {
        const Result<Profile> above = standing_above(coupon, *level);
        if (!above) return above.errors();
        layers.push_back({*above, *level, *std::next(level), {}, {}, "features"});
    }
    Facets facets;
    facets.chord = chord;
    Drawing drawing(facets);
    const Result<Solid> solid = stacked(drawing, layers);
    if (!solid) return solid.errors();
    Result<DrawnPart> part = drawn(drawing, *solid, "coupon", {.jacobian = false});
    if (!part) return part.errors();
    return std::move(part->mesh);
}

Result<Profile> coupon_outline(const Coupon& coupon) {
    FETTLE_ASSERT(coupon.kind == CouponKind::cut, "a cut coupon");
    // From the right along the fingers' tops and the gaps' feet to the left.
    std::vector<Point2> corners{{0, 0}, {coupon.width, 0}};
    std::vector<const CouponFeature*> edge;
    for (const CouponFeature& feature : coupon.features)
        if (feature.kind == FeatureKind::wall || feature.kind == FeatureKind::gap) edge.push_back(&feature);
    std::sort(edge.begin(), edge.end(), [](const auto* a, const auto* b) { return a->x > b->x; });
    const double foot = coupon.depth, top = foot + edge.front()->length;
    corners.push_back({coupon.width, top});
    for (const CouponFeature* feature : edge) {
        if (feature->kind != FeatureKind::gap) continue;
        const double left = feature->x - feature->nominal / 2, right = feature->x + feature->nominal / 2;
        corners.insert(corners.end(), {{right, top}, {right, foot}, {left, foot}, {left, top}});
    }
    const double first = edge.back()->x - edge.back()->nominal / 2;
    corners.insert(corners.end(), {{first, top}, {first, foot}, {0, foot}});
    const Result<Profile> whole = filled(polygon(corners, "plate"));
    if (!whole) return whole.errors();
    return with_holes(*whole, openings(coupon));
}

Result<std::string> coupon_svg(const Coupon& coupon) {
    const Result<Profile> outline = coupon_outline(coupon);
    if (!outline) return outline.errors();
    std::string text = exports::profile_svg(*outline);
    const auto mm = [](double metres) { return core::base::formatted("%.4g", metres * 1e3); };
    std::string lines;
    for (const CouponLabel& label : coupon.labels)
        for (const Bar& bar : bars_of(label.text, coupon.font)) {
            const bool is_level = bar.width > bar.height;
            const double x = label.x + bar.x, y = label.y + bar.y, s = coupon.font.stroke / 2;
            const auto point = [&](double px, double py) { return mm(px) + " " + mm(-py); };
            lines +=
                "M" + point(x + s, y + s) + "L" + (is_level ? point(x + bar.width - s, y + s) : point(x + s, y + bar.height - s + 1e-9));
        }
    const std::size_t end = text.rfind("</svg>");
    FETTLE_ASSERT(end != std::string::npos, "an SVG has an end");
    return text.insert(end, "<path fill=\"none\" stroke=\"blue\" stroke-width=\"0.1\" d=\"" + lines + "\"/>\n");
}

double volume_of(const core::geometry::Mesh& mesh) { return core::geometry::solid_moments(mesh.vertices, mesh.triangles)(3, 3); }

}  // namespace fettle::design::coupons
