// SPDX-License-Identifier: MIT
#include "core/parts/law_chords.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/parts/curve_geometry.hpp"

namespace fettle::core::parts::law_chords_test {

namespace {

using geometry::Range;

// Largest distance to the left and right of its chords that samples find, as the parameter rises.
std::array<double, 2> sampled(const Law& law, double low, double high, int count, int samples) {
    const auto at = [&](double t) {
        const auto p = law.bend(Jet<double>::parameter(t));
        return Vector2(p[0].value, p[1].value);
    };
    std::array<double, 2> out{0, 0};
    for (int k = 0; k < count; ++k) {
        const double from = low + (high - low) * k / count, to = low + (high - low) * (k + 1) / count;
        const Vector2 a = at(from), b = at(to), along = (b - a).normalized();
        for (int i = 1; i < samples; ++i) {
            const Vector2 d = at(from + (to - from) * i / samples) - a;
            const double aside = along.x() * d.y() - along.y() * d.x();
            out[0] = std::max(out[0], aside);
            out[1] = std::max(out[1], -aside);
        }
    }
    return out;
}

struct Case {
    const char* name;
    Law law;
    double low, high;
    double tightness;  ///< the bound is at most so many times what samples find; 0: of a line; negative: it says little
    int side;
};

std::vector<Case> cases() {
    std::vector<Case> out;
    const auto add = [&](const char* name, auto function, double low, double high, double tightness, int side) {
        out.push_back({name, Law(function), low, high, tightness, side});
    };
    add(
        "ellipse",
        [](const auto& t) {
            return std::array{3.0 * cos(t), 2.0 * sin(t)};
        },
        0.2, 5.0, 1.4, 1);
    add(
        "clockwise",
        [](const auto& t) {
            return std::array{3.0 * sin(t), 2.0 * cos(t)};
        },
        0.2, 5.0, 1.4, -1);
    add(
        "wave",
        [](const auto& t) {
            return std::array{t, 0.3 * sin(2.0 * t)};
        },
        -1, 4, 1.4, 0);
    add(
        "power of a base that begins at 0",
        [](const auto& t) {
            return std::array{t, pow(t, 3.0) - pow(t, 4.0)};
        },
        0, 1, 1.6, 0);
    add(
        "spiral of functions",
        [](const auto& t) {
            const auto r = hypot(1.0 + t, exp(0.3 * t)) + log(2.0 + t) + atan(t);
            return std::array{r * cos(t), r * sin(t)};
        },
        0.1, 3, 1.6, 1);
    add(
        "rise, then dwell",
        [](const auto& t) {
            const auto r = 5.0 + choose(t - 1.0, t * t * (3.0 - 2.0 * t), 0.0 * t + 1.0);
            return std::array{r * cos(t), r * sin(t)};
        },
        0, 2, 2, 0);
    add(
        "rise, dwell, fall, rest",
        [](const auto& t) {
            const auto s = t / 1.7, v = (t - 2.5) / 2.0;
            const auto rise = pow(s, 3.0) * (10.0 - s * (15.0 - 6.0 * s)), fall = 1.0 - pow(v, 3.0) * (10.0 - v * (15.0 - 6.0 * v));
            const auto one = 0.0 * t + 1.0;
            const auto r = 20.0 + 6.0 * choose(t - 1.7, rise, choose(t - 2.5, one, choose(t - 4.5, fall, 0.0 * t)));
            return std::array{r * cos(t), r * sin(t)};
        },
        0, 6.28, 1.6, 0);
    add(
        "corner",
        [](const auto& t) {
            return std::array{t, 0.1 * abs(t - 0.31)};
        },
        0, 1, 8, 0);
    add(
        "step",
        [](const auto& t) {
            return std::array{t, choose(t - 0.31, 0.0 * t, 0.1 + 0.0 * t)};
        },
        0, 1, -1, 0);
    add(
        "line",
        [](const auto& t) {
            return std::array{1.0 + 2.0 * t, 3.0 - t};
        },
        0, 1, 0, 0);
    return out;
}

}  // namespace

TEST_CASE("no point of a law's curve is farther from its chords than is proven") {
    for (const Case& c : cases()) {
        for (const int count : {1, 3, 12, 50}) {
            INFO(c.name << ", " << count << " chords");
            const ChordDeviation bound = chord_deviation(c.law, c.low, c.high, count);
            const auto [left, right] = sampled(c.law, c.low, c.high, count, 20'000 / count);
            const double found = std::max(left, right);
            REQUIRE(std::isfinite(bound.distance));
            CHECK(found <= bound.distance + 1e-15);
            if (c.tightness > 0 && count >= 12) CHECK(bound.distance <= c.tightness * found);
            if (c.tightness == 0) CHECK(bound.distance < 1e-12);
            if (count >= 12) CHECK(bound.side == c.side);
            if (bound.side == 1) CHECK(left <= 1e-14);
            if (bound.side == -1) CHECK(right <= 1e-14);
        }
    }
}

TEST_CASE("what is not bounded is not said to be") {
    // A pole, a root of negative numbers, an angle that jumps.
    CHECK(chord_deviation(Law([](const auto& t) { return std::array{t, 1.0 / (t - 0.4)}; }), 0, 1, 10).distance == INFINITY);
    CHECK(chord_deviation(Law([](const auto& t) { return std::array{t, sqrt(t - 0.4)}; }), 0, 1, 10).distance == INFINITY);
    CHECK(chord_deviation(Law([](const auto& t) { return std::array{t, atan2(t - 0.4, -1.0 + 0.0 * t)}; }), 0, 1, 10).distance == INFINITY);
    CHECK(chord_deviation(Law(), 0, 1, 10).distance == INFINITY);
}

TEST_CASE("an offset of a law is bounded too") {
    for (const Case& c : cases()) {
        if (std::string(c.name) == "corner" || std::string(c.name) == "step" || std::string(c.name) == "line") continue;
        // Its curvature jumps, and so the slope of its offset: at the end of a chord, where that does not matter.
        const double tightness = std::string(c.name) == "rise, then dwell" ? 20 : 3;
        for (const double distance : {-0.7, -0.05, 0.04, 0.3}) {
            const LawCurve curve = law_curve(c.law, c.low, c.high);
            const auto moved = beside(curve, distance);
            REQUIRE(moved);
            const Law& law = *std::get<LawCurve>(*moved).law;
            for (const int count : {12, 60}) {
                INFO(c.name << " at " << distance << ", " << count << " chords");
                const ChordDeviation bound = chord_deviation(law, c.low, c.high, count);
                const auto [left, right] = sampled(law, c.low, c.high, count, 20'000 / count);
                CHECK(std::max(left, right) <= bound.distance + 1e-15);
                CHECK(bound.distance < tightness * std::max(left, right));
                if (bound.side == 1) CHECK(left <= 1e-14);
                if (bound.side == -1) CHECK(right <= 1e-14);
            }
        }
    }
}

TEST_CASE("what operations give over a stretch contains what they give within it") {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) { return low + (high - low) * static_cast<double>(random()) / 4294967296.0; };
    using expression::Operation;
    for (int k = 0; k < 40'000; ++k) {
        const auto operation = static_cast<Operation>(static_cast<int>(Operation::negate) +
                                                      k % (static_cast<int>(Operation::choose) - static_cast<int>(Operation::negate) + 1));
        std::array<Range, 3> ranges;
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = uniform(-3, 3), width = std::pow(10, uniform(-6, 0.3));
            const double low = operation == Operation::power && i == 1 && k % 3 > 0 ? std::round(a) : a,
                         high = low == a ? low + width : low;
            ranges[i] = Range(low, high);
            at[i] = low + (high - low) * uniform(0, 1);
        }
        const auto over = expression::applied<Jet<Range>>(operation, Jet<Range>(ranges[0], 1.0, 0.0), Jet<Range>(ranges[1], 0.0, 0.0),
                                                          Jet<Range>(ranges[2], 0.0, 0.0));
        const auto here = expression::applied<Jet<double>>(operation, Jet<double>(at[0], 1.0, 0.0), Jet<double>(at[1], 0.0, 0.0),
                                                           Jet<double>(at[2], 0.0, 0.0));
        INFO("operation " << static_cast<int>(operation) << " at " << at[0] << ", " << at[1] << ", " << at[2]);
        const auto holds = [&](const Range& range, double x) {
            // Where it is not defined, nothing is said.
            if (!std::isfinite(x)) return !range.is_bounded() || range.switches || range.has_gaps;
            const double slack = 1e-14 * (1 + std::abs(x));
            return range.low <= x + slack && x - slack <= range.high;
        };
        CHECK(holds(over.value, here.value));
        CHECK(holds(over.first, here.first));
        CHECK(holds(over.second, here.second));
    }
}

}  // namespace fettle::core::parts::law_chords_test
