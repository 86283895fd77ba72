// SPDX-License-Identifier: MIT
// How long does a part take to be drawn with its Jacobian: the first time, and again with its structure kept, as a trial of a design does?
// A plate of layers and holes, and a revolved knob; ten dimensions each, 1,000 and 10,000 triangles. Before a time counts the volume is
// checked against the polygons' closed form. Prints JSON: milliseconds of the processor (all threads), best of five; `unchecked`: without
// the check that the mesh is a solid.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/geometry/mass_moments.hpp"
#include "core/parts/drawn_part.hpp"
#include "core/parts/extrude.hpp"
#include "core/parts/revolve.hpp"
#include "core/parts/solid_booleans.hpp"

using namespace fettle;
using namespace fettle::core::parts;

namespace {

using PartFunction = std::function<Result<Solid>(Drawing&, const std::vector<Number>&)>;

// A disc with a ring of holes, a hub of another radius on it, a bore through both; its rim is chamfered.
Result<Solid> plate(Drawing& drawing, const std::vector<Number>& d) {
    auto disc = with_hole(*filled(circle({}, d[0], "rim")), circle({}, d[1], "bore"));
    if (!disc) return disc.errors();
    disc = with_holes(*disc, polar_copies(circle({d[2], 0}, d[3], "hole"), 12));
    if (!disc) return disc.errors();
    disc = with_holes(*disc, polar_copies(slot({d[4], 0}, {d[4] + d[5], 0}, d[6], "slot"), 5));
    if (!disc) return disc.errors();
    const auto hub = with_hole(*filled(circle({}, d[7], "hub")), circle({}, d[1], "bore"));
    if (!hub) return hub.errors();
    return stacked(drawing, {{*disc, 0, d[8], {}, {}, "disc"}, {*hub, d[8], d[8] + d[9], {}, {}, "hub"}});
}

Result<Solid> knob(Drawing& drawing, const std::vector<Number>& d) {
    const auto loop = Path({d[0], 0}, "knob")
                          .line_to({d[1], 0})
                          .round(d[8])
                          .line_to({d[1], d[2]})
                          .round(d[8])
                          .line_to({d[3], d[2]})
                          .round(d[9])
                          .line_to({d[4], d[5]})
                          .bulge_to({d[6], d[7]}, 0.4)
                          .line_to({d[0], d[7]})
                          .closed();
    if (!loop) return loop.errors();
    const auto profile = filled(*loop);
    return profile ? revolved(drawing, *profile) : Result<Solid>(profile.errors());
}

// The plate with two bores from its rim to its middle.
Result<Solid> bored_plate(Drawing& drawing, const std::vector<Number>& d) {
    const auto whole = plate(drawing, d);
    if (!whole) return whole;
    const auto pin = extruded(drawing, *filled(circle({}, 0.3 * d[8], "cross bore")), 0, 2.0 * d[0]);
    if (!pin) return pin;
    const Solid across = moved(turned(*pin, {0, 1, 0}, std::numbers::pi / 2), {0, 0.1 * d[0], 0.47 * d[8]});
    const auto cut = difference(drawing, *whole, across);
    if (!cut) return cut;
    return difference(drawing, *cut, turned(across, {0, 0, 1}, 2));
}

struct Drawn {
    DrawnPart part;
    double milliseconds = 0;
};

Drawn draw(const PartFunction& part, const std::vector<double>& dimensions, const Facets& facets, const Structure& kept, bool check) {
    const std::clock_t start = std::clock();
    Drawing drawing(facets, kept);
    std::vector<Number> numbers;
    for (const double d : dimensions) numbers.push_back(drawing.dimension(d));
    const auto solid = part(drawing, numbers);
    if (!solid) {
        std::fprintf(stderr, "%s\n", solid.errors().front().message.c_str());
        std::exit(1);
    }
    auto out = drawn(drawing, *solid, "part", {true, check});
    if (!out) {
        std::fprintf(stderr, "%s\n", out.errors().front().message.c_str());
        std::exit(1);
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return {std::move(*out), 1e3 * seconds};
}

double best_of_five(const std::function<double()>& once) {
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 5; ++k) best = std::min(best, once());
    return best;
}

}  // namespace

int main() {
    struct Case {
        const char* name;
        PartFunction part;
        std::vector<double> dimensions;
        int segments;
    };
    const std::vector<double> of_plate{40e-3, 5e-3, 32e-3, 3e-3, 12e-3, 12e-3, 2e-3, 9e-3, 5e-3, 8e-3},
        of_knob{3e-3, 20e-3, 6e-3, 12e-3, 9e-3, 14e-3, 6e-3, 22e-3, 1e-3, 2e-3};
    std::vector<Case> cases{
        {"plate", plate, of_plate, 12}, {"plate", plate, of_plate, 124}, {"knob", knob, of_knob, 30}, {"knob", knob, of_knob, 114}};
    if (has_solid_booleans()) cases.push_back({"bored plate", bored_plate, of_plate, 124});
    std::printf("[\n");
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const Case& c = cases[k];
        const Facets facets{0, c.segments, Lean::through};
        const Drawn first = draw(c.part, c.dimensions, facets, {}, true);
        const double volume = core::geometry::solid_moments(first.part.mesh.vertices, first.part.mesh.triangles)(3, 3);
        if (std::string(c.name) == "plate") {
            const auto& d = c.dimensions;
            const double n = c.segments, circle = n / 2 * std::sin(2 * std::numbers::pi / n);
            const double disc = circle * (d[0] * d[0] - d[1] * d[1] - 12 * d[3] * d[3] - 5 * d[6] * d[6]) - 5 * d[5] * 2 * d[6];
            const double exact = disc * d[8] + circle * (d[7] * d[7] - d[1] * d[1]) * d[9];
            if (!(std::abs(volume - exact) < 1e-12 * exact)) {
                std::fprintf(stderr, "volume %.17g instead of %.17g\n", volume, exact);
                return 1;
            }
        }
        const double anew = best_of_five([&] { return draw(c.part, c.dimensions, facets, {}, true).milliseconds; });
        const double again = best_of_five([&] { return draw(c.part, c.dimensions, facets, first.part.structure, true).milliseconds; });
        const double unchecked = best_of_five([&] { return draw(c.part, c.dimensions, facets, first.part.structure, false).milliseconds; });
        std::printf(
            "  {\"part\": \"%s\", \"triangles\": %zu, \"dimensions\": %zu, \"first_ms\": %.3f, \"again_ms\": %.3f, \"unchecked_ms\": "
            "%.3f}%s\n",
            c.name, first.part.mesh.triangles.size(), c.dimensions.size(), anew, again, unchecked, k + 1 < cases.size() ? "," : "");
    }
    std::printf("]\n");
}
