// SPDX-License-Identifier: MIT
// Numbers at the start, where there are any: every kind of quantity that instants have numbers of, by every way to make one of them,
// against the numbers themselves and, for derivatives, against differences of whole simulations.
#include <catch2/catch.hpp>
#include <numbers>

#include "design/quantities/step_series.hpp"
#include "tests/design/quantities/file_problem.hpp"

namespace fettle::design::quantities::start_instant_test {

namespace {

using tests::design_support::check_gradient;
using tests::design_support::problem_of;

// Crank, rod and slider in line at the start, driven at once; a spring pulls the slider back.
const char* slider_crank = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.07, "gravity": [0, -9.81, 0],
    "variables": {"r": "153mm", "l": "306mm"},
    "bodies": [{"name": "crank", "group": "g", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}},
               {"name": "rod", "group": "g", "density": 1000, "shape": {"part": "box"}, "position": ["= r", 0, 0]},
               {"name": "slider", "group": "g", "density": 1000, "shape": {"part": "box"}, "position": ["= r + l", 0, 0]}],
    "joints": [{"name": "O", "type": "revolute", "b": "crank", "point_a": [0, 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "A", "type": "revolute", "a": "crank", "b": "rod", "point_a": ["= r", 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "B", "type": "revolute", "a": "rod", "b": "slider", "point_a": ["= l", 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "S", "type": "prismatic", "b": "slider", "point_a": [0, 0, 0], "point_b": [0, 0, 0], "axis": [1, 0, 0], "stiffness": 200,
                "rest": "400 mm"}],
    "motors": [{"name": "drive", "joint": "O", "angle": {"rate": 3000}}]})";

struct Kind {
    std::string text;
    bool has_start;
};
const std::vector<Kind> kinds{
    {R"("type": "marker_position", "body": "slider", "point": [0, 0, 0], "axis": [1, 0, 0])", true},
    {R"("type": "marker_position", "body": "rod", "point": [9, 5, 0], "origin": [1, 2, 3])", true},
    {R"("type": "joint_position", "joint": "S")", true},
    {R"("type": "joint_position", "joint": "O")", true},
    {R"("type": "turn", "body": "rod", "axis": [0, 0, 1])", true},
    {R"("type": "law", "of": "length", "times": [0, 1], "values": ["= l", 900])", true},
    {R"("type": "energy", "of": "potential")", true},
    {R"("type": "energy", "of": "spring")", true},
    {R"("type": "expression", "expression": "x * cos(turn) + 2 mm/s * time")", true},
    {R"("type": "expression", "expression": "x * x / most + r")", true},
    {R"("type": "marker_speed", "body": "slider", "point": [0, 0, 0], "axis": [1, 0, 0])", false},
    {R"("type": "energy", "of": "kinetic")", false},
    {R"("type": "energy", "of": "total")", false},
    {R"("type": "joint_force", "joint": "A", "axis": [1, 0, 0])", false},
    {R"("type": "motor_effort", "motor": "drive")", false},
    {R"("type": "expression", "expression": "effort * turn / 1 rad")", false},
};

std::string design_of(const std::vector<std::string>& constraints) {
    std::string list;
    for (const std::string& constraint : constraints)
        list += (list.empty() ? "{" : ", {") + constraint + R"(, "name": "c)" + std::to_string(list.size()) + "\"}";
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "r", "lower": 140, "upper": 160}, {"name": "l", "lower": 300, "upper": 320}],
        "quantities": {"x": {"type": "joint_position", "joint": "S"}, "turn": {"type": "turn", "body": "crank", "axis": [0, 0, 1]},
                       "most": {"type": "joint_position", "joint": "S", "over": "largest"},
                       "effort": {"type": "motor_effort", "motor": "drive"}},
        "constraints": [)" +
           list + "]}";
}

constexpr int steps = 7;

}  // namespace

TEST_CASE("start instant: what a position is at a time before the first step's end, in closed form") {
    const auto place = [](double time, double r, double l) {
        const double turn = 3000 * std::numbers::pi / 180 * time;
        return r * std::cos(turn) + std::sqrt(l * l - std::pow(r * std::sin(turn), 2));
    };
    std::vector<std::string> asked;
    for (const std::string& taken : {R"("at": 0)", R"("at": 0.002)", R"("at": 0.01)", R"("over": "largest")"})
        asked.push_back(kinds[0].text + ", " + taken + R"(, "lower": 0)");
    asked.push_back(R"("type": "stroke", "body": "slider", "axis": [1, 0, 0], "lower": 0)");
    asked.push_back(kinds[0].text + R"(, "over": "least", "lower": 0)");
    const auto problem = problem_of(slider_crank, design_of(asked));
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const auto value = [&](int k) { return at.constraints[k].value; };
    const double start = place(0, 0.153, 0.306), first = place(0.01, 0.153, 0.306);
    CHECK(value(0) == Approx(start).epsilon(1e-9));
    CHECK(value(1) == Approx(0.8 * start + 0.2 * first).epsilon(1e-9));
    CHECK(value(2) == Approx(first).epsilon(1e-9));
    CHECK(value(3) == Approx(start).epsilon(1e-9));
    CHECK(value(4) == Approx(value(3) - value(5)).epsilon(1e-9));
    CHECK(at.jacobian(0, 0) == Approx(1).epsilon(1e-9));
    CHECK(at.jacobian(0, 1) == Approx(1).epsilon(1e-9));
}

TEST_CASE("start instant: every kind of quantity by every way to take it, and its derivatives") {
    for (const Kind& kind : kinds) {
        std::vector<std::string> asked;
        for (const char* taken : {R"("over": "end")", R"("over": "sum")", R"("over": "mean")", R"("over": "largest")", R"("over": "least")",
                                  R"("over": "peak")", R"("over": "rms")", R"("over": "mean", "from": 0, "to": 0.03)",
                                  R"("over": "rms", "from": 0.01)", R"("at": 0.01)", R"("at": 0.0125)", R"("at": 0.06)"})
            asked.push_back(kind.text + ", " + taken + R"(, "lower": -1e9)");
        if (kind.has_start)
            for (const char* taken : {R"("at": 0)", R"("at": 0.0025)", R"("over": "largest", "to": 0.005)"})
                asked.push_back(kind.text + ", " + taken + R"(, "lower": -1e9)");
        CAPTURE(kind.text);
        const auto problem = problem_of(slider_crank, design_of(asked));
        const auto at = problem.evaluate(description::values_of(problem.design().parameters));
        INFO(at.reason);
        REQUIRE(at.usable);
        const problem::SimulatedDesign simulated(problem.design(), at);
        const auto& first = *series_of(*problem.design().constraints[0].quantity);
        const std::vector<double> y = first.numbers(simulated.in(0));
        REQUIRE(count_of(y) == steps + (kind.has_start ? 1 : 0));
        const auto value = [&](int k) { return at.constraints[k].value; };
        const auto close = [](double v) { return Approx(v).epsilon(1e-12).margin(1e-12); };
        const auto& [least, largest] = std::minmax_element(y.begin(), y.end());
        double sum = 0, squares = 0;
        for (const double v : y) sum += v, squares += v * v;
        const auto count = static_cast<double>(y.size());
        CHECK(value(0) == close(y.back()));
        CHECK(value(1) == close(sum));
        CHECK(value(2) == close(sum / count));
        CHECK(value(3) >= *largest - 1e-12);  // a parabola's may be more
        CHECK(value(4) <= *least + 1e-12);
        CHECK(value(6) == close(std::sqrt(squares / count)));
        const std::size_t end_of_first = kind.has_start ? 1 : 0;
        CHECK(value(7) ==
              close(std::accumulate(y.begin(), y.begin() + 3 + static_cast<long>(end_of_first), 0.0) / (kind.has_start ? 4 : 3)));
        CHECK(value(9) == close(y[end_of_first]));
        CHECK(value(10) == close(0.75 * y[end_of_first] + 0.25 * y[end_of_first + 1]));
        if (kind.has_start) {
            CHECK(value(12) == close(y[0]));
            CHECK(value(13) == close(0.75 * y[0] + 0.25 * y[1]));
            CHECK(value(14) == close(y[0]));
        }
        check_gradient(problem, 1e-5);
    }
}

TEST_CASE("start instant: what is a step's is refused before the first step's end, by name") {
    for (const Kind& kind : kinds)
        for (const char* taken : {R"("at": 0)", R"("at": 0.0099)", R"("over": "largest", "to": 0.005)"}) {
            const tests::support::TemporaryFolder folder;
            folder.write("small.scene.json", slider_crank);
            auto file =
                reading::parse_design(design_of({kind.text + ", " + taken + R"(, "lower": -1e9)"}), folder.file("small.design.json"));
            REQUIRE(file);
            const auto problem = problem::DesignProblem::create(std::move(file->design));
            CAPTURE(kind.text, taken);
            CHECK(static_cast<bool>(problem) == kind.has_start);
            if (!problem) CHECK(problem.errors()[0].message.find("0.01 s") != std::string::npos);
        }
}

}  // namespace fettle::design::quantities::start_instant_test
