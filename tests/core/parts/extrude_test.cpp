// SPDX-License-Identifier: MIT
#include "fettle/core/parts/extrude.hpp"

#include <cmath>
#include <numbers>

#include "fettle/tests/core/parts/part_check.hpp"

namespace fettle::core::parts::extrude_test {

using part_check::checked;
using part_check::draw;
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
    CHECK(part.deviation.proven);
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
    const auto frustum = [&](double inset, double height) {
        return height / 3 * (a * b + (a - 2 * inset) * (b - 2 * inset) + std::sqrt(a * b * (a - 2 * inset) * (b - 2 * inset)));
    };
    // A prismatoid: (A + 4 M + B) h / 6.
    const double end = c / 6 * (a * b + 4 * (a - c) * (b - c) + (a - 2 * c) * (b - 2 * c));
    (void)frustum;
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

TEST_CASE("an extrusion that cannot be says why") {
    const auto flat = [](Drawing& drawing, const std::vector<Number>& d) {
        return extruded(drawing, *filled(circle({}, d[0], "collar")), d[1], d[1]);
    };
    CHECK(part_check::told(draw(flat, {1e-3, 2e-3}).errors()) == "collar: `collar` has no height: 0 mm\n");
    const auto blunt = [](Drawing& drawing, const std::vector<Number>& d) {
        return extruded(drawing, *filled(circle({}, d[0], "pin")), 0, 1e-2, {d[1], 1e-3});
    };
    CHECK(part_check::told(draw(blunt, {1e-3, 2e-3}).errors()).find("a chamfer or draft of 2 mm is larger than `pin`") !=
          std::string::npos);
}

}  // namespace fettle::core::parts::extrude_test
