// SPDX-License-Identifier: MIT
#include "core/parts/triangulation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "core/geometry/predicates.hpp"

namespace fettle::core::parts::triangulation_test {

using geometry::orient2d;
using std::numbers::pi;

namespace {

void add_loop(PlaneRegion& region, const std::vector<Vector2>& points) {
    std::vector<int> loop;
    for (const Vector2& p : points) {
        loop.push_back(count_of(region.points));
        region.points.push_back(p);
    }
    region.loops.push_back(loop);
}

double area(const PlaneRegion& region) {
    double twice = 0;
    for (const auto& loop : region.loops) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vector2 &p = region.points[loop[k]], &q = region.points[loop[(k + 1) % loop.size()]];
            twice += p.x() * q.y() - p.y() * q.x();
        }
    }
    return twice / 2;
}

// Positive triangles whose sides are the loops' edges, and otherwise in pairs; they have the region's area.
void check(const PlaneRegion& region) {
    const Triangulation made = triangulated(region);
    REQUIRE_FALSE(made.triangles.empty());
    CHECK(fits(region, made.triangles));
    std::map<std::pair<int, int>, int> sides;
    double sum = 0;
    for (const auto& t : made.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
        const Vector2 &a = region.points[t[0]], &b = region.points[t[1]], &c = region.points[t[2]];
        sum += ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
    }
    for (const auto& loop : region.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) --sides[{loop[k], loop[(k + 1) % loop.size()]}];
    for (const auto& [side, count] : sides) {
        const auto back = sides.find({side.second, side.first});
        const int other = back == sides.end() ? 0 : back->second;
        REQUIRE(count == other);
        REQUIRE(count <= 1);
    }
    CHECK(sum == Approx(area(region)).epsilon(1e-12));
}

std::vector<Vector2> star(const Vector2& centre, int n, double low, double high, std::mt19937& random, bool clockwise) {
    std::vector<Vector2> out;
    for (int k = 0; k < n; ++k) {
        const double r = low + (high - low) * static_cast<double>(random()) / 4294967296.0, angle = (clockwise ? -1 : 1) * 2 * pi * k / n;
        out.push_back(centre + r * Vector2(std::cos(angle), std::sin(angle)));
    }
    return out;
}

}  // namespace

TEST_CASE("random regions with holes are filled exactly") {
    std::mt19937 random(11);
    for (int trial = 0; trial < 60; ++trial) {
        PlaneRegion region;
        const int n = 5 + static_cast<int>(random() % 200);
        add_loop(region, star({0, 0}, n, 4, 9, random, false));
        for (int k = 0; k < static_cast<int>(random() % 5); ++k)
            add_loop(region, star(2.2 * Vector2(std::cos(k * 1.3), std::sin(k * 1.3)), 3 + static_cast<int>(random() % 30), 0.2, 1.0,
                                  random, true));
        // An island in a hole's place, and another outline beside.
        add_loop(region, star({20, 0}, 12, 1, 3, random, false));
        check(region);
    }
}

TEST_CASE("points in rows, on circles and on grids") {
    PlaneRegion comb;
    std::vector<Vector2> points;
    for (int k = 0; k <= 40; ++k) points.push_back({k, 0});
    for (int k = 40; k >= 0; --k) points.push_back({k, k % 2 == 0 ? 1 : 5});
    add_loop(comb, points);
    check(comb);
    PlaneRegion ring;
    std::vector<Vector2> outer, inner;
    for (int k = 0; k < 300; ++k) {
        outer.push_back(3 * Vector2(std::cos(2 * pi * k / 300), std::sin(2 * pi * k / 300)));
        inner.push_back(2 * Vector2(std::cos(2 * pi * k / 300), -std::sin(2 * pi * k / 300)));
    }
    add_loop(ring, outer);
    add_loop(ring, inner);
    check(ring);
}

TEST_CASE("what crosses or touches is found") {
    PlaneRegion bow;
    add_loop(bow, {{0, 0}, {1, 1}, {1, 0}, {0, 1}});
    CHECK(triangulated(bow).crossing);
    PlaneRegion touching;
    add_loop(touching, {{0, 0}, {4, 0}, {4, 4}, {0, 4}});
    add_loop(touching, {{1, 0}, {1, 2}, {2, 2}});
    const auto fault = triangulated(touching);
    CHECK(fault.triangles.empty());
    CHECK(fault.crossing);
    PlaneRegion twice;
    add_loop(twice, {{0, 0}, {4, 0}, {4, 4}, {0, 0}});
    CHECK(triangulated(twice).crossing);
    PlaneRegion backwards;
    add_loop(backwards, {{0, 0}, {0, 1}, {1, 1}, {1, 0}});
    CHECK(triangulated(backwards).triangles.empty());
    PlaneRegion out_of_hole;
    add_loop(out_of_hole, {{0, 0}, {4, 0}, {4, 4}, {0, 4}});
    add_loop(out_of_hole, {{3, 1}, {3, 2}, {6, 1}});
    CHECK(triangulated(out_of_hole).crossing);
}

}  // namespace fettle::core::parts::triangulation_test
