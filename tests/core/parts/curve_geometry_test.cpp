// SPDX-License-Identifier: MIT
#include "core/parts/curve_geometry.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/parts/jet.hpp"

namespace fettle::core::parts::curve_geometry_test {

using std::numbers::pi;

namespace {

Law limacon() {
    return Law([](const auto& t) {
        using std::cos, std::sin;
        const auto r = 2.0 + cos(t);
        return std::array{r * cos(t), r * sin(t)};
    });
}

std::vector<Curve> all_kinds() {
    std::vector<Curve> out{Line{{1, 2}, {4, 3}},
                           Arc{polar(2, 0.3), polar(2, 2.5), {0, 0}, 2, true},
                           Arc{polar(2, 0.3), polar(2, 2.5), {0, 0}, 2, false},
                           Arc{{2, 0}, {2, 0}, {0, 0}, 2, true},
                           Arc{{2, 0}, {2, 0}, {0, 0}, 2, false},
                           Bezier{{Point2{0, 0}, {1, 2}, {3, 2}, {4, -1}}},
                           Bezier{{Point2{0, 0}, {1, 2}, {2, -2}, {3, 0}}},
                           law_curve(limacon(), 0.2, 4.0),
                           law_curve(limacon(), 3.0, 0.5),
                           involute(1, 0.3, 0.1, 1.2),
                           involute(1, 0.3, 1.2, 0.1, true)};
    return out;
}

double distance(const Vector2& p, const Vector2& a, const Vector2& b) {
    const double u = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - u * (b - a)).norm();
}

}  // namespace

TEST_CASE("velocities and bendings are those of differences, recorded tangents too") {
    for (const Curve& curve : all_kinds()) {
        for (const double u : {0.1, 0.37, 0.8}) {
            const double h = 1e-5;
            const Vector2 velocity = (at(curve, u + h).position - at(curve, u - h).position) / (2 * h);
            CHECK((at(curve, u).velocity - velocity).norm() < 1e-8 * (1 + velocity.norm()));
            const Vector2 bend = (at(curve, u + h).velocity - at(curve, u - h).velocity) / (2 * h);
            CHECK((bending(curve, u) - bend).norm() < 1e-7 * (1 + bend.norm()));
            CHECK((value(point_at(curve, u)) - at(curve, u).position).norm() < 1e-14 * 10);
            CHECK((value(tangent_at(curve, u)) - at(curve, u).velocity).norm() < 1e-13 * 10);
        }
    }
}

TEST_CASE("a part of a curve, the reverse, the nearest point and the curve beside it") {
    for (const Curve& curve : all_kinds()) {
        const Cut from{0.2, 0.2, point_at(curve, 0.2)}, to{0.7, 0.7, point_at(curve, 0.7)};
        const Curve part = between(curve, from, to), back = reversed(part);
        for (const double u : {0.0, 0.3, 0.9, 1.0}) {
            const Vector2 p = at(part, u).position;
            CHECK((p - at(curve, 0.2 + 0.5 * u).position).norm() < 1e-13 * 10);
            CHECK((at(back, 1 - u).position - p).norm() < 1e-13 * 10);
            CHECK(distance_to(curve, p) < 1e-12);
        }
        const double shift = std::holds_alternative<Line>(curve) ? 0.5 : 0.05;
        const auto moved = beside(curve, shift);
        REQUIRE(moved);
        for (const double u : {0.2, 0.5, 0.8}) {
            const CurvePoint c = at(curve, u);
            const Vector2 left(-c.velocity.y(), c.velocity.x());
            CHECK((at(*moved, u).position - c.position - shift * left.normalized()).norm() < 1e-12);
            const Vector2 velocity = (at(*moved, u + 1e-6).position - at(*moved, u - 1e-6).position) / 2e-6;
            CHECK((at(*moved, u).velocity - velocity).norm() < 1e-8 * (1 + velocity.norm()));
        }
    }
}

TEST_CASE("no point of a curve is farther from its chain than is said, nor on the other side") {
    std::mt19937 random(3);
    const auto uniform = [&](double a, double b) { return a + (b - a) * static_cast<double>(random()) / 4294967296.0; };
    std::vector<Curve> curves = all_kinds();
    for (int k = 0; k < 40; ++k) {
        const Point2 p[4] = {{0, 0}, {uniform(-1, 2), uniform(-2, 2)}, {uniform(0, 3), uniform(-2, 2)}, {3, uniform(-1, 1)}};
        curves.push_back(Bezier{{p[0], p[1], p[2], p[3]}});
        const double r = uniform(0.1, 3), a = uniform(0, 6), b = a + uniform(0.1, 6);
        curves.push_back(Arc{polar(r, a), polar(r, b), {0, 0}, r, k % 2 == 0});
    }
    for (const Curve& curve : curves) {
        for (const Lean lean : {Lean::cover, Lean::within, Lean::through}) {
            const Facets facets{0, 24, lean};
            const Chain chain = chain_of(curve, facet_count(curve, facets), lean);
            std::vector<Vector2> points;
            if (chain.through_start) points.push_back(value(start_of(curve)));
            for (const Point2& p : chain.inner) points.push_back(value(p));
            points.push_back(chain.through_start ? value(end_of(curve)) : points.front());
            double farthest_out = 0, farthest_in = 0;
            for (int k = 0; k <= 2000; ++k) {
                const Vector2 p = at(curve, k / 2000.0).position;
                double nearest = INFINITY;
                bool left = false;
                for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                    const double d = distance(p, points[i], points[i + 1]);
                    if (d >= nearest) continue;
                    nearest = d;
                    const Vector2 e = points[i + 1] - points[i], f = p - points[i];
                    left = e.x() * f.y() - e.y() * f.x() > 0;
                }
                (left ? farthest_in : farthest_out) = std::max(left ? farthest_in : farthest_out, nearest);
            }
            // Distances to corners are seen from the side of an edge that may be the wrong one by rounding.
            CHECK(farthest_out <= chain.out + 1e-14);
            CHECK(farthest_in <= chain.in + 1e-14);
            if (std::holds_alternative<Arc>(curve)) {
                CHECK(std::max(farthest_in, farthest_out) > 0.4 * std::max(chain.in, chain.out));
                const bool convex = std::get<Arc>(curve).counter_clockwise;
                if (lean == Lean::cover) CHECK(chain.out == 0);
                if (lean == Lean::within) CHECK(chain.in == 0);
                if (lean == Lean::through) CHECK((convex ? chain.in : chain.out) == 0);
            }
        }
    }
}

TEST_CASE("the number of segments keeps the chord") {
    for (const double chord : {1e-4, 1e-3, 1e-2}) {
        for (const Curve& curve : all_kinds()) {
            for (const Lean lean : {Lean::cover, Lean::within, Lean::through}) {
                const Chain chain = chain_of(curve, facet_count(curve, {chord, 48, lean}), lean);
                CHECK(std::max(chain.in, chain.out) <= chord * (1 + 1e-9));
            }
        }
    }
    CHECK(segments_of({1e-5, 0}, 10e-3, 2 * pi) % 4 == 0);
    CHECK(segments_of({0, 48}, 1, pi / 3) == 8);
    CHECK(segments_of({0, 48}, 1, 0.01) == 1);
}

TEST_CASE("splines go through their points with two continuous derivatives") {
    const std::vector<Point2> points{{0, 0}, {1, 2}, {3, 1}, {4, 4}, {6, 0}};
    for (const bool closed : {false, true}) {
        const auto spline = spline_through(points, closed);
        REQUIRE(spline.size() == (closed ? 5u : 4u));
        for (std::size_t k = 0; k + (closed ? 0 : 1) < spline.size(); ++k) {
            const Curve a = spline[k], b = spline[(k + 1) % spline.size()];
            CHECK(value(end_of(a)) == value(points[(k + 1) % points.size()]));
            // In the parameter that runs as the square root of the chord.
            const auto step = [&](std::size_t i) {
                return std::sqrt((value(points[(i + 1) % points.size()]) - value(points[i % points.size()])).norm());
            };
            const double h = step(k), g = step(k + 1);
            CHECK((at(a, 1).velocity / h - at(b, 0).velocity / g).norm() < 1e-12);
            CHECK((bending(a, 1) / (h * h) - bending(b, 0) / (g * g)).norm() < 1e-11);
        }
        if (!closed) CHECK(bending(Curve(spline.front()), 0).norm() < 1e-12);
        const auto by_control = b_spline(points, closed);
        for (std::size_t k = 0; k + (closed ? 0 : 1) < by_control.size(); ++k) {
            const Curve a = by_control[k], b = by_control[(k + 1) % by_control.size()];
            CHECK((at(a, 1).velocity - at(b, 0).velocity).norm() < 1e-12);
            CHECK((bending(a, 1) - bending(b, 0)).norm() < 1e-11);
        }
        if (!closed) {
            CHECK(value(start_of(Curve(by_control.front()))) == value(points.front()));
            CHECK(value(end_of(Curve(by_control.back()))) == value(points.back()));
        }
    }
}

TEST_CASE("jets know the derivatives of every operation") {
    const auto f = [](const auto& t) {
        using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::exp, std::hypot, std::log, std::pow, std::sin,
            std::sqrt, std::tan;
        using expression::choose, expression::maximum, expression::minimum;
        auto out = sqrt(t) + sin(t) * cos(2.0 * t) / tan(0.3 * t) + asin(0.4 * t) - acos(0.3 * t) + atan(t) + exp(t) * log(t);
        out = out + pow(t, 2.5) + pow(2.0, t) + pow(t, t) + pow(t, 1.0) + atan2(t, 1.0 + t * t) + hypot(t, 2.0) + abs(-t);
        return out + minimum(t, 10.0 + t * t) + maximum(t * t, -t) + choose(t - 5.0, t * t * t, t);
    };
    const double t = 1.3, h = 1e-4;
    const auto jet = f(Jet<double>::parameter(t));
    CHECK(jet.value == Approx(f(t)).epsilon(1e-14));
    CHECK(jet.first == Approx((f(t + h) - f(t - h)) / (2 * h)).epsilon(1e-7));
    CHECK(jet.second == Approx((f(t + h) - 2 * f(t) + f(t - h)) / (h * h)).epsilon(1e-6));
    const auto recorded = f(Jet<Number>::parameter(t));
    CHECK(recorded.first.value == Approx(jet.first).epsilon(1e-14));
    CHECK(recorded.second.value == Approx(jet.second).epsilon(1e-14));
}

}  // namespace fettle::core::parts::curve_geometry_test
