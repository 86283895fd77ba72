// SPDX-License-Identifier: MIT
// Path synthesis with revolute joints (examples/path_line, path_arc, path_loop) against the sums of squares known of these problems, and
// against trigonometry: the coupler's angle by the triangle of crank pin, rocker pivot and rocker pin.
#include <catch2/catch.hpp>
#include <complex>
#include <numbers>

#include "design/studies/optimise_design.hpp"
#include "tests/design/examples/example_files.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::examples::path_synthesis_test {

namespace {

using tests::design_support::Example;
using Complex = std::complex<double>;
using Values = std::map<std::string, double>;  // mm, rad

double value(const Values& p, const std::string& name) { return p.count(name) > 0 ? p.at(name) : 0; }

// The coupler's point at a crank angle. @param side  1 or -1: on which side of the line from crank pin to rocker pivot the rocker pin is.
Complex point_at(const Values& p, double angle, int side) {
    const double a = p.at("crank"), ground = a + p.at("y") + p.at("z"), coupler = a + p.at("x") + p.at("z"),
                 rocker = a + p.at("x") + p.at("y");
    const Complex pin = std::polar(a, angle), diagonal = ground - pin;
    const double length = std::abs(diagonal);
    const double at_pin = std::acos((coupler * coupler + length * length - rocker * rocker) / (2 * coupler * length));
    const Complex point = pin + Complex(p.at("point_x"), p.at("point_y")) * std::polar(1.0, std::arg(diagonal) + side * at_pin);
    return Complex(value(p, "place_x"), value(p, "place_y")) + point * std::polar(1.0, value(p, "tilt"));
}

// The sum of squares of whichever way the linkage is put together.
double sum_of_squares(const Values& p, const std::vector<Complex>& targets, const std::vector<double>& angles) {
    double least = INFINITY;
    for (const int side : {1, -1}) {
        double sum = 0;
        for (size_t k = 0; k < targets.size(); ++k) sum += std::norm(point_at(p, angles[k], side) - targets[k]);
        least = std::min(least, sum);
    }
    return least;
}

constexpr double degree = std::numbers::pi / 180;

struct Case {
    std::string name;
    std::vector<Complex> targets;
    double limit = 0;  // of the sum of squares [mm^2]

    std::vector<double> angles(const Values& p) const {
        std::vector<double> out;
        if (name == "path_arc") return {30 * degree, 45 * degree, 60 * degree, 75 * degree, 90 * degree};
        double angle = p.at("crank_angle");
        for (size_t k = 0; k < targets.size(); ++k) {
            if (name == "path_line" && k > 0) angle += p.at("step_" + std::to_string(k));
            out.push_back(name == "path_line" ? angle : angle + 20 * degree * static_cast<double>(k));
        }
        return out;
    }
    double sum(const Values& p) const { return sum_of_squares(p, targets, angles(p)); }
};

// From facts.md section 5: an exact solution; the least known, times 1.00001.
const Case line{"path_line", {{20, 20}, {20, 25}, {20, 30}, {20, 35}, {20, 40}, {20, 45}}, 1e-12};
const Case arc{"path_arc", {{3, 3}, {2.759, 3.363}, {2.372, 3.663}, {1.890, 3.862}, {1.355, 3.943}}, 7.41575e-7 * 1.00001};
const Case loop{"path_loop",
                {{.5, 1.1},
                 {.4, 1.1},
                 {.3, 1.1},
                 {.2, 1},
                 {.1, .9},
                 {.005, .75},
                 {.02, .6},
                 {0, .5},
                 {0, .4},
                 {.03, .3},
                 {.1, .25},
                 {.15, .2},
                 {.2, .3},
                 {.3, .4},
                 {.4, .5},
                 {.5, .7},
                 {.6, .9},
                 {.6, 1}},
                0.00991193 * 1.00001};

// The values of a design's parameters, SI.
Values values_of(const Example& example, const VectorX& p) {
    Values out;
    for (size_t k = 0; k < example.design.parameters.size(); ++k) {
        const auto& parameter = example.design.parameters[k];
        const double si = p[k];
        out[parameter.name] = parameter.unit.dimension == Dimension::length ? 1e3 * si : si;
    }
    return out;
}

// The values of result.json, from the parameters' own units.
Values values_of(const Example& example, const nlohmann::json& parameters) {
    VectorX p(example.design.parameters.size());
    for (size_t k = 0; k < example.design.parameters.size(); ++k) {
        const auto& parameter = example.design.parameters[k];
        p[k] = to_si(parameters.at(parameter.name).get<double>(), parameter.unit);
    }
    return values_of(example, p);
}

void check_optimised(const Case& of, double objective, const Values& values) {
    CAPTURE(of.name, objective, of.limit);
    CHECK(objective <= of.limit);
    CHECK(of.sum(values) == Approx(objective).epsilon(1e-6).margin(1e-13));
    for (const auto& [name, value] : values) {
        if (name != "crank") continue;
        const double longest =
            std::max({values.at("y") + values.at("z"), values.at("x") + values.at("z"), values.at("x") + values.at("y")});
        CHECK(value + longest <= (of.name == "path_line" ? 60 : 50));
    }
}

}  // namespace

TEST_CASE("path synthesis: every start closes where trigonometry has it") {
    for (const Case& of : {line, arc, loop}) {
        const Example example = Example::read(of.name);
        const auto at = example.problem.evaluate(example.start, {false, {}, {}});
        CAPTURE(of.name, at.reason);
        REQUIRE(at.usable);
        CHECK(of.sum(values_of(example, example.start)) == Approx(at.objective).epsilon(1e-9));
    }
}

TEST_CASE("path synthesis: the arc from its own start") {
    const Example example = Example::read("path_arc");
    const auto outcome = studies::optimise_design(example.problem, {});
    REQUIRE(outcome);
    CHECK(outcome->report.status == optimisers::OptimiserStatus::optimal);
    check_optimised(arc, outcome->report.best.objective, values_of(example, outcome->report.point));
}

TEST_CASE("path synthesis: line, arc and loop from many starts", "[slow]") {
    for (const auto& [of, starts] : {std::pair(line, 16), std::pair(arc, 4), std::pair(loop, 8)}) {
        const Example example = Example::read(of.name);
        const tests::support::TemporaryFolder folder;
        const auto answer = tests::support::run("optimise examples/" + of.name + "/" + of.name + ".design.json --starts " +
                                                std::to_string(starts) + " --json --out " + folder.file("out"));
        const nlohmann::json result = answer.json();
        CAPTURE(of.name, answer.code, answer.out.substr(0, 400));
        REQUIRE(result.is_object());
        CHECK(answer.code == 0);
        check_optimised(of, result.at("objective").get<double>(), values_of(example, result.at("parameters")));
    }
}

}  // namespace fettle::design::examples::path_synthesis_test
