// SPDX-License-Identifier: MIT
#include "core/parts/extrude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::extrude_test {

using part_check::checked;
using part_check::draw;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

namespace {

Result<Solid> washer(Drawing& drawing, const std::vector<Number>& d) {
    const auto ring = with_hole(*filled(circle({}, d[0] + d[1], "rim")), circle({}, d[0], "bore"));
    if (!ring) return ring.errors();
    return extruded(drawing, *ring, 0, d[2]);
}

}  // namespace

TEST_CASE("a washer has the volume of its polygons, which cover the part by default") {
    const int n = 48;
    const double bore = 5e-3, rim = 7e-3, height = 1e-3, share = n / pi * std::sin(pi / n) * std::cos(pi / n);
    const DrawnPart part = checked(washer, {bore, rim - bore, height}, {0, n});
    const double flat = std::cos(pi / n);
    CHECK(volume(part) == Approx(pi * share * (rim * rim / (flat * flat) - bore * bore) * height).epsilon(1e-12));
    CHECK(part.deviation.out < 1e-15);
    CHECK(part.deviation.in == Approx(std::max(rim * (1 / flat - 1), bore * (1 - flat))));
    CHECK((part.deviation.out_is_proven && part.deviation.in_is_proven));
    // Faces: rim and bore stand for cylinders.
    int cylinders = 0;
    for (const DrawnSurface& surface : part.surfaces) {
        if (surface.kind != SurfaceKind::cylinder) continue;
        ++cylinders;
        CHECK(surface.radius == (surface.hollow ? bore : rim));
        CHECK(surface.feature == (surface.hollow ? "bore" : "rim"));
    }
    CHECK(cylinders == 2);
}

TEST_CASE("ends draw in: a chamfered bar and a drafted one") {
    const auto bar = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return extruded(drawing, *filled(rectangle({}, d[0], d[1], "bar")), 0, d[2], {d[3], d[3]}, {d[3], d[3]});
    };
    const double a = 10e-3, b = 6e-3, h = 4e-3, c = 0.5e-3;
    const DrawnPart part = checked(bar, {a, b, h, c});
    // A prismatoid: (A + 4 M + B) h / 6.
    const double end = c / 6 * (a * b + 4 * (a - c) * (b - c) + (a - 2 * c) * (b - 2 * c));
    CHECK(volume(part) == Approx(a * b * (h - 2 * c) + 2 * end).epsilon(1e-12));
    CHECK(part.deviation.out < 1e-15);

    const auto pin = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return extruded(drawing, *filled(circle({}, d[0], "pin")), 0, d[1], {}, {d[2], d[1]});
    };
    const double r = 3e-3, length = 8e-3, draft = 0.4e-3;
    const int n = 60;
    const DrawnPart drafted = checked(pin, {r, length, draft}, {0, n});
    const double share = n / pi * std::tan(pi / n);
    CHECK(volume(drafted) == Approx(pi * share * length / 3 * (r * r + r * (r - draft) + (r - draft) * (r - draft))).epsilon(1e-12));
}

TEST_CASE("ends draw in along arcs, splines and corners of all kinds") {
    const auto cam = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto loop = Path({0, 0}, "cam")
                              .round(d[3])
                              .line_to({d[0], 0})
                              .arc_through({1.3 * d[0], 0.5 * d[1]}, {d[0], d[1]})
                              .chamfer(d[3])
                              .line_to({0, d[1]})
                              .closed();
        if (!loop) return loop.errors();
        auto profile = with_hole(*filled(*loop), slot({0.4 * d[0], 0.4 * d[1]}, {0.6 * d[0], 0.5 * d[1]}, d[3], "slot"));
        if (!profile) return profile.errors();
        return extruded(drawing, *profile, 0, d[2], {0.3 * d[3], 0.4 * d[3]}, {0.2 * d[3], 0.3 * d[3]});
    };
    const DrawnPart part = checked(cam, {20e-3, 12e-3, 3e-3, 1e-3});
    CHECK(part.deviation.in > 0);
    for (std::size_t t = 0; t < part.facets.size(); ++t) {
        const DrawnSurface& surface = part.surfaces[part.facets[t].surface];
        if (surface.kind != SurfaceKind::plane) continue;
        // The three corners are in the plane that the facet stands for.
        for (const int v : part.mesh.triangles[t]) {
            const Vector3 p = part.mesh.vertices.col(v) - Vector3(surface.point[0], surface.point[1], surface.point[2]);
            CHECK(std::abs(p.dot(Vector3(surface.axis[0], surface.axis[1], surface.axis[2]))) < 1e-14);
        }
    }
}

TEST_CASE("layers stand on each other: a crank of collar, disc and pin") {
    const auto crank = [](Drawing& drawing, const std::vector<Number>& d) {
        const auto bore = circle({}, d[0], "bore");
        return stacked(drawing,
                       {{*with_hole(*filled(circle({}, d[1], "collar")), bore), 0, d[4], {}, {}, "collar"},
                        {*with_hole(*filled(circle({}, d[2], "disc")), bore), d[4], d[4] + d[5], {0.1 * d[5], 0.1 * d[5]}, {}, "disc"},
                        {*filled(circle({d[3], 0}, d[0], "pin")), d[4] + d[5], 2.0 * d[4] + d[5], {}, {0.2 * d[0], 0.2 * d[0]}, "pin"}});
    };
    const std::vector<double> d{2e-3, 4e-3, 12e-3, 9e-3, 5e-3, 3e-3};
    const int n = 64;
    const DrawnPart part = checked(crank, d, {0, n, Lean::through});
    const double share = n / 2.0 / pi * std::sin(2 * pi / n), h = 0.1 * d[5], c = 0.2 * d[0];
    const auto frustum = [](double r, double q, double height) { return pi * height / 3 * (r * r + r * q + q * q); };
    const double collar = pi * (d[1] * d[1] - d[0] * d[0]) * d[4];
    const double disc =
        pi * d[2] * d[2] * (d[5] - h) + frustum(d[2], d[2] - h, h) - pi * d[0] * d[0] * (d[5] - h) - frustum(d[0], d[0] + h, h);
    const double pin = pi * d[0] * d[0] * (d[4] - c) + frustum(d[0], d[0] - c, c);
    CHECK(volume(part) == Approx(share * (collar + disc + pin)).epsilon(1e-12));
    // The bore of the disc is widened where it meets the collar's; nothing hangs in the air.
    CHECK(told(draw(
                   [](Drawing& drawing, const std::vector<Number>& e) {
                       return stacked(drawing, {{*filled(circle({}, e[0], "disc")), 0, e[1], {}, {}, {}},
                                                {*filled(circle({3.0 * e[0], 0}, e[0], "pin")), e[1], 2.0 * e[1], {}, {}, {}}});
                   },
                   {1e-3, 2e-3})
                   .errors()) == "pin: `pin` does not stand on `disc`, the layer below it\n");
}

TEST_CASE("layers that cross, share sides or are the same") {
    const auto part_of = [](const Profile& below, const Profile& above) {
        return [below, above](Drawing& drawing, const std::vector<Number>& d) {
            return stacked(drawing, {{below, 0, d[0], {}, {}, "below"}, {above, d[0], d[0] + d[1], {}, {}, "above"}});
        };
    };
    const auto a = *filled(rectangle({0, 0}, 4, 2, "a"));
    for (const auto& [b, area_b] : {std::pair{*filled(rectangle({2, 0}, 4, 2, "b")), 8.0},
                                    {*filled(rectangle({1, 1}, 2, 4, "b")), 8.0},
                                    {*filled(rectangle({0, 0}, 2, 2, "b")), 4.0},
                                    {a, 8.0},
                                    {*filled(rectangle({1, 0}, 1, 2, "b")), 2.0},
                                    {*filled(polygon({{-1, -1}, {5, 1}, {2, 5}}, "b")), 15.0}}) {
        const DrawnPart part = checked(part_of(a, b), {1, 2});
        CHECK(volume(part) == Approx(8 * 1 + area_b * 2).epsilon(1e-12));
    }
    // Crossing layers whose outlines depend on dimensions.
    const auto cross = [](Drawing& drawing, const std::vector<Number>& d) {
        return stacked(drawing, {{*filled(rectangle({0, 0}, d[0], d[1], "a")), 0, d[2], {}, {}, {}},
                                 {*filled(circle({0.8 * d[0], d[1]}, d[3], "b")), d[2], 2.0 * d[2], {}, {}, {}},
                                 {*filled(rectangle({0.7 * d[0], 0.6 * d[1]}, d[0], d[1], "c")), 2.0 * d[2], 3.0 * d[2], {}, {}, {}}});
    };
    checked(cross, {4e-3, 2e-3, 1e-3, 1.3e-3});
    // The same outline with other dimensions keeps its structure; one that cuts it otherwise is told.
    const auto first = draw(cross, {4e-3, 2e-3, 1e-3, 1.3e-3});
    const auto near = draw(cross, {4.01e-3, 2e-3, 1e-3, 1.31e-3}, {}, first->structure);
    REQUIRE(near);
    CHECK(near->changes.empty());
    CHECK(near->mesh.triangles == first->mesh.triangles);
    const auto other = draw(cross, {4e-3, 2e-3, 1e-3, 0.3e-3}, {}, first->structure);
    REQUIRE(other);
    CHECK_FALSE(other->changes.empty());
}

TEST_CASE("edges shorter than the tolerance become points, where a step cuts outlines: at their start, in a row, all of them") {
    const double e = 1e-10;
    const auto two = [](const std::vector<Point2>& above, bool swapped) {
        return [above, swapped](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
            const auto wide = filled(rectangle({}, 200, 200, "wide")), small = filled(polygon(above, "small"));
            if (!small) return small.errors();
            const Profile &below = swapped ? *small : *wide, &on_top = swapped ? *wide : *small;
            return stacked(drawing, {{below, 0, d[0], {}, {}, {}}, {on_top, d[0], 2.0 * d[0], {}, {}, {}}});
        };
    };
    const std::vector<Point2> corners{{1, 1}, {10, 1}, {10, 10}, {1, 10}};
    for (std::size_t corner = 0; corner < 4; ++corner)
        for (const int tiny : {1, 2, 3, 7})
            for (std::size_t start = 0; start < 4 + static_cast<std::size_t>(tiny); ++start)
                for (const bool swapped : {false, true}) {
                    std::vector<Point2> points = corners;
                    const Vector2 at = value(corners[corner]), along = value(corners[(corner + 1) % 4]) - at;
                    for (int k = tiny; k > 0; --k)
                        points.insert(points.begin() + static_cast<std::ptrdiff_t>(corner) + 1, constant(Vector2(at + k * e * along)));
                    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(start % points.size()), points.end());
                    const auto part = draw(two(points, swapped), {1});
                    INFO("corner " << corner << ", " << tiny << " edges, from " << start << told(part.errors()));
                    REQUIRE(part);
                    CHECK(volume(*part) == Approx(40000 + 81).epsilon(1e-9));
                    CHECK(tests::support::fault_of_solid(part->mesh) == "");
                    CHECK(part->deviation.out >= e);  // corners are moved together, which is told
                }
    // A profile that is nothing beside the layer below it: whatever it is, it ends.
    for (const double size : {1e-5, 1e-7, 1e-9})
        for (const bool swapped : {false, true}) {
            const auto part = draw(two({{1, 1}, {1 + size, 1}, {1 + size, 1 + size}, {1, 1 + size}}, swapped), {1});
            if (part)
                CHECK(tests::support::fault_of_solid(part->mesh) == "");
            else
                CHECK_FALSE(part.errors().front().message.empty());
        }
}

TEST_CASE("an extrusion that cannot be says why") {
    const auto flat = [](Drawing& drawing, const std::vector<Number>& d) {
        return extruded(drawing, *filled(circle({}, d[0], "collar")), d[1], d[1]);
    };
    CHECK(told(draw(flat, {1e-3, 2e-3}).errors()) == "collar: `collar` has no height: 0 mm\n");
    const auto blunt = [](Drawing& drawing, const std::vector<Number>& d) {
        return extruded(drawing, *filled(circle({}, d[0], "pin")), 0, 1e-2, {d[1], 1e-3});
    };
    CHECK(told(draw(blunt, {1e-3, 2e-3}).errors()).find("a chamfer or draft of 2 mm is larger than `pin`") != std::string::npos);
}

}  // namespace fettle::core::parts::extrude_test
