// SPDX-License-Identifier: MIT
// The four-bar linkage against trigonometry (examples/README.md).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "design/quantities/marker.hpp"
#include "tests/design/examples/example_files.hpp"

namespace fettle::design::examples::four_bar_test {

namespace {

using tests::design_support::Example;
using Complex = std::complex<double>;

enum Body { base, crank, coupler, rocker };
constexpr int segments = 20;
constexpr double pi = std::numbers::pi;

// Ideal joints; the links' directions at crank angle 0 are those of the scene.
struct Linkage {
    double crank = 0, coupler = 0, rocker = 0, point_x = 0, point_y = 0;

    Complex pivot() const { return crank + std::polar(coupler, 0.2 * pi) - std::polar(rocker, 0.4 * pi); }

    /// Angle of the coupler at a crank angle: triangle of pin, pivot and rocker's pin, on the side on which it is drawn.
    double coupler_angle(double angle) const {
        const Complex diagonal = pivot() - std::polar(crank, angle);
        const double length = std::abs(diagonal);
        return std::arg(diagonal) + std::acos((coupler * coupler + length * length - rocker * rocker) / (2 * coupler * length));
    }
    Complex point(double angle) const {
        return std::polar(crank, angle) + Complex(point_x, point_y) * std::polar(1.0, coupler_angle(angle));
    }
};

const Linkage target_linkage = {17e-3, 52e-3, 42e-3, 24e-3, 22e-3};

Linkage linkage_at(const Example& example, const VectorX& p) {
    const auto value = [&](const char* name) { return p[example.parameter(name)]; };
    return {value("crank_length"), value("coupler_length"), value("rocker_length"), value("point_x"), value("point_y")};
}

Complex place(const problem::DesignEvaluation& e, int t, int body, const Complex& point) {
    const description::Simulated simulated{*e.runs.front().model, e.runs.front().simulation.trajectory};
    const Vector3 world = quantities::marker_position(simulated, t, body, Vector3(point.real(), point.imag(), 0));
    CHECK(std::abs(world.z()) < 1e-12);
    return {world.x(), world.y()};
}

// Furthest that a pin's axis gets from its bore's: a vertex of the pin's polygon in a corner of the bore's.
double furthest(double bore, double pin) { return bore / std::cos(pi / segments) - pin * std::cos(pi / segments); }

TEST_CASE("example four-bar: the points of the file are those of the target linkage") {
    std::ifstream file("examples/four_bar/four_bar.design.json");
    const nlohmann::json path = nlohmann::json::parse(file)["objective"][0];
    REQUIRE(path["points"].size() == 12);
    for (size_t k = 0; k < path["points"].size(); ++k) {
        const Complex point = 1e3 * target_linkage.point(2 * pi * path["times"][k].get<double>());
        CHECK(std::abs(path["points"][k][0].get<double>() - point.real()) < 0.5001e-3);
        CHECK(std::abs(path["points"][k][1].get<double>() - point.imag()) < 0.5001e-3);
        CHECK(path["points"][k][2] == 0);
    }
}

TEST_CASE("example four-bar: anywhere within the bounds the crank can turn") {
    const Example example = Example::read("four_bar");
    const auto at = [&](const char* name, int part) {
        const auto& parameter = example.design.parameters[example.parameter(name)];
        return parameter.lower + part * (parameter.upper - parameter.lower) / 10;
    };
    for (int i = 0; i <= 10; ++i) {
        for (int j = 0; j <= 10; ++j) {
            for (int k = 0; k <= 10; ++k) {
                const Linkage linkage = {at("crank_length", i), at("coupler_length", j), at("rocker_length", k)};
                std::array<double, 4> lengths = {linkage.crank, linkage.coupler, linkage.rocker, std::abs(linkage.pivot())};
                std::sort(lengths.begin(), lengths.end());
                CHECK(lengths[0] == linkage.crank);
                CHECK(lengths[0] + lengths[3] < lengths[1] + lengths[2]);  // Grashof
            }
        }
    }
}

TEST_CASE("example four-bar: every pin stays in its bore, and the coupler's point where trigonometry has it, within the play") {
    const Example example = Example::read("four_bar");
    REQUIRE(example.design.parameters.size() == 9);
    const auto evaluation = example.problem.evaluate(example.start, {false, {}, {}});
    INFO(evaluation.reason);
    REQUIRE(evaluation.usable);
    CHECK(evaluation.violation > 0.04e-3);  // of the fits

    const Linkage linkage = linkage_at(example, example.start);
    const double journal_play = furthest(4.5e-3, 4.4e-3), pin_play = furthest(3.4e-3, 3.3e-3);
    const int last = count_of(evaluation.runs.front().simulation.trajectory.poses) - 1;
    CHECK(last == 100);
    double deviation = 0;
    for (int t = 0; t <= last; ++t) {
        const Complex point(linkage.point_x, linkage.point_y);
        const Complex crank_pin = place(evaluation, t, crank, linkage.crank), rocker_pin = place(evaluation, t, rocker, linkage.rocker);
        CHECK(std::abs(place(evaluation, t, crank, 0)) < journal_play);
        CHECK(std::abs(place(evaluation, t, rocker, 0) - linkage.pivot()) < journal_play);
        CHECK(std::abs(place(evaluation, t, coupler, -point) - crank_pin) < pin_play);
        CHECK(std::abs(place(evaluation, t, coupler, linkage.coupler - point) - rocker_pin) < pin_play);
        deviation = std::max(deviation, std::abs(place(evaluation, t, coupler, 0) - linkage.point(2 * pi * t / last)));
    }
    INFO("largest deviation " << deviation * 1e3 << " mm");
    CHECK(deviation < 2 * (journal_play + pin_play));
}

TEST_CASE("example four-bar: with the target's dimensions the path is met but for the play, and all requirements are met") {
    const Example example = Example::read("four_bar");
    const VectorX p = example.values({{"crank_length", target_linkage.crank},
                                      {"coupler_length", target_linkage.coupler},
                                      {"rocker_length", target_linkage.rocker},
                                      {"point_x", target_linkage.point_x},
                                      {"point_y", target_linkage.point_y},
                                      {"crank_journal_radius", 4.35e-3},
                                      {"crank_pin_radius", 3.235e-3},
                                      {"rocker_pin_radius", 3.235e-3},
                                      {"rocker_journal_radius", 4.35e-3}});
    const auto evaluation = example.problem.evaluate(p, {false, {}, {}});
    INFO(evaluation.reason);
    REQUIRE(evaluation.usable);
    CHECK(evaluation.violation == 0);
    CHECK(std::sqrt(evaluation.terms[0].value) < furthest(4.5e-3, 4.35e-3));
    CHECK(evaluation.constraints[example.constraint("crank:base")].value ==
          Approx(4.5e-3 - 4.35e-3 * std::cos(pi / segments)).epsilon(1e-6));
}

}  // namespace

}  // namespace fettle::design::examples::four_bar_test
