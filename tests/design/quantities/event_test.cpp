// SPDX-License-Identifier: MIT
// Events, what is at them, and shares of time: an offset slider-crank, whose times are known in closed form, a pendulum, and a drop onto a
// floor.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/problem/motion_warnings.hpp"
#include "design/quantities/event_time.hpp"
#include "tests/design/quantities/file_problem.hpp"

namespace fettle::design::quantities::event_test {

namespace {

using tests::design_support::check_gradient;
using tests::design_support::problem_of;

// A crank that turns once a second, a rod, and a slide whose line passes it at a distance: it goes out slower than it comes back.
std::string quick_return(double timestep) {
    return R"({"fettle_scene": 1, "units": "mm", "timestep": )" + std::to_string(timestep) + R"(, "end_time": 1.3, "gravity": [0, 0, 0],
    "variables": {"r": "30mm", "l": "90mm", "e": "20mm"},
    "bodies": [{"name": "crank", "group": "g", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}},
               {"name": "rod", "group": "g", "density": 1000, "shape": {"part": "box"}, "position": ["= r", 0, 0],
                "rotation": [0, 0, "= asin(e / l) "]},
               {"name": "slide", "group": "g", "density": 1000, "shape": {"part": "box"}, "position": ["= r + sqrt(l^2 - e^2) ", "= e", 0]}],
    "joints": [{"name": "O", "type": "revolute", "b": "crank", "point_a": [0, 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "A", "type": "revolute", "a": "crank", "b": "rod", "point_a": ["= r", 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "B", "type": "revolute", "a": "rod", "b": "slide", "point_a": ["= l", 0, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "S", "type": "prismatic", "b": "slide", "point_a": [0, "= e", 0], "point_b": [0, 0, 0], "axis": [1, 0, 0]}],
    "motors": [{"name": "drive", "joint": "O", "angle": {"rate": 360}}]})";
}

std::string design_of(const std::string& quantities, const std::string& constraints, const std::string& more = "") {
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "r", "lower": 25, "upper": 35}, {"name": "l", "lower": 85, "upper": 95}, {"name": "e", "lower": 15, "upper": 25}],
        "quantities": {)" +
           quantities + R"(}, "constraints": [)" + constraints + "]" + more + "}";
}

const char* const slide_and_crank = R"("slide": {"type": "marker_position", "body": "slide", "point": [0, 0, 0], "axis": [1, 0, 0]},
    "crank": {"type": "joint_position", "joint": "O"},
    "outer": {"type": "event_time", "of": "slide", "derivative": 1, "direction": "falling"},
    "inner": {"type": "event_time", "of": "slide", "derivative": 1, "direction": "rising"},
    "again": {"type": "event_time", "of": "slide", "derivative": 1, "direction": "falling", "occurrence": 2},
    "ratio": {"type": "expression", "expression": "(inner - outer) / (again - inner) "})";

struct Lengths {
    double r = 0.03, l = 0.09, e = 0.02;
};

// Where the slide is when the crank has turned by this.
double place(double angle, const Lengths& of = {}) {
    return of.r * std::cos(angle) + std::sqrt(of.l * of.l - std::pow(of.e - of.r * std::sin(angle), 2));
}
// The crank's angles at which the slide turns round.
double outer_angle(const Lengths& of) { return std::asin(of.e / (of.l + of.r)); }
double inner_angle(const Lengths& of) { return std::numbers::pi + std::asin(of.e / (of.l - of.r)); }
double time_ratio(const Lengths& of) {
    const double out = inner_angle(of) - outer_angle(of);
    return out / (2 * std::numbers::pi - out);
}
// The crank's angle between two at which the slide is at x.
double angle_at(double x, double low, double high) {
    const bool rises = place(high) > place(low);
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        ((place(middle) > x) == rises ? high : low) = middle;
    }
    return low;
}
double time_of(double angle) { return angle / (2 * std::numbers::pi); }

problem::DesignEvaluation evaluated(const problem::DesignProblem& problem) {
    problem::DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    return at;
}

// The constraints' names, which are taken for the quantities'.
std::string bound(const std::string& of, const std::string& name) {
    return R"({"type": "expression", "expression": ")" + of + R"(", "name": ")" + name + R"(", "lower": -1e9})";
}

}  // namespace

TEST_CASE("events: a quick-return's times and ratio in closed form, closer as steps are smaller", "[event_test]") {
    const Lengths of;
    double last = 0;
    for (const double timestep : {0.02, 0.01, 0.005}) {
        const auto problem =
            problem_of(quick_return(timestep),
                       design_of(slide_and_crank, bound("outer", "outer") + "," + bound("inner", "inner") + "," + bound("ratio", "ratio")));
        const auto at = evaluated(problem);
        CAPTURE(timestep, at.constraints[0].value, at.constraints[1].value, at.constraints[2].value);
        CHECK(at.constraints[0].value == Approx(time_of(outer_angle(of))).margin(6 * timestep * timestep));
        CHECK(at.constraints[1].value == Approx(time_of(inner_angle(of))).margin(6 * timestep * timestep));
        const double error = std::abs(at.constraints[2].value - time_ratio(of));
        CHECK(error < 12 * timestep * timestep);
        if (last > 0) CHECK(std::log2(last / error) > 1.7);
        last = error;
    }
}

TEST_CASE("events: the derivatives of a quick-return's ratio are those of the closed form", "[event_test]") {
    const auto problem = problem_of(quick_return(0.005), design_of(slide_and_crank, bound("ratio", "ratio")));
    const auto at = evaluated(problem);
    const Lengths of;
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
        Lengths above = of, below = of;
        double Lengths::*const members[] = {&Lengths::r, &Lengths::l, &Lengths::e};
        above.*members[k] += h;
        below.*members[k] -= h;
        const double expected = (time_ratio(above) - time_ratio(below)) / (2 * h);
        CHECK(at.jacobian(0, k) == Approx(expected).epsilon(2e-3));
    }
}

TEST_CASE("events: crossings of a threshold, first, second and last, rising and falling, in a window", "[event_test]") {
    const std::string asked = R"({"type": "event_time", "of": "slide", "threshold": 100, "lower": 0},
        {"type": "event_time", "of": "slide", "threshold": 100, "direction": "rising", "lower": 0},
        {"type": "event_time", "of": "slide", "threshold": "= l + 10 mm", "occurrence": -1, "lower": 0},
        {"type": "event_time", "of": "slide - 100 mm", "from": 0.3, "lower": 0},
        {"type": "event_time", "of": "crank", "threshold": "200deg", "lower": 0},
        {"type": "value_at", "of": "slide", "time": "inner", "lower": 0},
        {"type": "value_at", "of": "crank", "time": "(outer + inner) / 2", "lower": 0},
        {"type": "value_at", "of": "slide", "derivative": 1, "time": "inner", "lower": -1000, "upper": 1000},
        {"type": "time_share", "of": "slide", "above": 100, "to": 1, "lower": 0},
        {"type": "time_share", "of": "slide", "below": "= l + 10 mm", "along": "crank", "to": 1, "lower": 0},
        {"type": "time_share", "of": "slide", "above": 500, "lower": 0},
        {"type": "time_share", "of": "slide", "below": 500, "lower": 0},
        {"type": "time_share", "of": "slide", "derivative": 1, "below": 0, "to": 1, "lower": 0})";
    const auto problem = problem_of(quick_return(0.005), design_of(slide_and_crank, asked));
    const auto at = evaluated(problem);
    const auto value = [&](int k) { return at.constraints[k].value; };
    const Lengths of;
    const double turn = 2 * std::numbers::pi, out = outer_angle(of), in = inner_angle(of);
    const double falls = time_of(angle_at(0.1, out, in)), rises = time_of(angle_at(0.1, in, out + turn));
    CHECK(value(0) == Approx(falls).margin(1e-6));
    CHECK(value(1) == Approx(rises).margin(1e-6));
    CHECK(value(2) == Approx(1 + falls).margin(1e-6));
    CHECK(value(3) == Approx(rises).margin(1e-6));
    CHECK(value(4) == Approx(200.0 / 360).margin(1e-9));
    CHECK(value(5) == Approx(std::sqrt(0.06 * 0.06 - 0.02 * 0.02)).margin(1e-8));
    CHECK(value(6) == Approx(0.5 * (out + in)).margin(2e-3));
    CHECK(value(7) == Approx(0).margin(1e-12));
    CHECK(value(8) == Approx(1 - (rises - falls)).margin(2e-6));
    CHECK(value(9) == Approx(rises - falls).margin(2e-6));
    CHECK(value(10) == 0);
    CHECK(value(11) == 1);
    CHECK(value(12) == Approx(time_of(in - out)).margin(2e-4));
    check_gradient(problem, 2e-6);
}

TEST_CASE("events: a pendulum's quarter and half swings, and the speed that it has at the bottom", "[event_test]") {
    const char* scene =
        R"({"fettle_scene": 1, "units": "mm", "timestep": 0.0005, "end_time": 0.4, "gravity": [0, -9.81, 0], "integrator": "bdf2",
        "variables": {"a": "100mm"},
        "bodies": [{"name": "bob", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 1, "size_y": 1, "size_z": 1}},
                    "position": ["= a * sin(0.1) ", "= -a * cos(0.1) ", 0]}],
        "joints": [{"name": "pivot", "type": "revolute", "b": "bob", "point": [0, 0, 0], "axis": [0, 0, 1]}]})";
    const char* design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "a", "lower": 80, "upper": 120}],
        "quantities": {"x": {"type": "marker_position", "body": "bob", "point": [0, 0, 0], "axis": [1, 0, 0]},
                       "down": {"type": "event_time", "of": "x", "direction": "falling"},
                       "turned": {"type": "event_time", "of": "x", "derivative": 1, "from": 0.01}},
        "constraints": [{"type": "expression", "expression": "down", "lower": 0}, {"type": "expression", "expression": "turned", "lower": 0},
                        {"type": "value_at", "of": "x", "derivative": 1, "time": "down", "lower": -1e4},
                        {"type": "value_at", "of": "x", "time": "turned", "lower": -1e4}]})";
    const auto problem = problem_of(scene, design);
    const auto at = evaluated(problem);
    // With the amplitude 0.1 the period is 2 pi sqrt(a'/g) (1 + 0.1^2/16 + ..), a' = a + its own inertia/(m a).
    const double length = 0.1 + (1e-6 / 6) / 0.1, period = 2 * std::numbers::pi * std::sqrt(length / 9.81) * (1 + 0.01 / 16 + 11e-4 / 3072);
    CHECK(at.constraints[0].value == Approx(period / 4).epsilon(2e-5));
    CHECK(at.constraints[1].value == Approx(period / 2).epsilon(2e-5));
    CHECK(at.constraints[2].value == Approx(-0.1 * std::sqrt(2 * 9.81 * (1 - std::cos(0.1)) / length)).epsilon(1e-4));
    CHECK(at.constraints[3].value == Approx(-0.1 * std::sin(0.1)).epsilon(3e-5));  // the steps damp a little
    CHECK(at.jacobian(0, 0) == Approx(at.constraints[0].value / (2 * 0.1)).epsilon(1e-3));
    check_gradient(problem, 1e-5);
}

TEST_CASE("events: contact that is made and lost, by the gap and by the force", "[event_test]") {
    // A block falls onto a floor; a spring pulls it up again.
    const char* scene = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.001, "end_time": 0.08, "gravity": [0, 0, -9.81],
        "variables": {"h": "2mm"}, "contact": {"dhat": "0.05mm"},
        "bodies": [{"name": "floor", "type": "static", "position": [0, 0, -5], "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 60, "size_z": 10}}},
                   {"name": "box", "density": 1000, "position": [3, 2, "= 10 mm + h"], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 20, "size_z": 20}}}]})";
    const char* design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "h", "lower": 1.5, "upper": 2.5}],
        "quantities": {"between": {"type": "gap", "a": "box", "b": "floor"},
                       "pressed": {"type": "contact_force", "body": "box", "of": "floor"}},
        "constraints": [{"type": "event_time", "of": "between", "threshold": 0.2, "direction": "falling", "lower": 0},
                        {"type": "event_time", "of": "pressed", "threshold": "0.01 N", "direction": "rising", "lower": 0},
                        {"type": "gap", "a": "box", "b": "floor", "over": "least", "lower": 0},
                        {"type": "gap", "a": "box", "b": "floor", "at": 0.01, "lower": 0}]})";
    const auto problem = problem_of(scene, design);
    const auto at = evaluated(problem);
    // Implicit Euler falls g h^2 k(k + 1)/2 in k steps of h, so about half a step ahead.
    CHECK(at.constraints[0].value == Approx(std::sqrt(2 * 1.8e-3 / 9.81)).margin(6e-4));
    CHECK(at.constraints[1].value > at.constraints[0].value);
    CHECK(at.constraints[1].value == Approx(std::sqrt(2 * 1.95e-3 / 9.81)).margin(1.5e-3));
    CHECK(at.constraints[2].value > 0);
    CHECK(at.constraints[2].value < 0.05e-3);
    CHECK(at.constraints[3].value == Approx(2e-3 - 9.81 * 1e-6 * 55).epsilon(1e-8));
    CHECK(at.jacobian(0, 0) > 0);
    CHECK(at.jacobian(3, 0) == Approx(1).epsilon(1e-9));
    check_gradient(problem, 1e-4);
}

TEST_CASE("events: one that does not happen has no time, and says how near it came", "[event_test]") {
    const auto reason = [](const std::string& asked) {
        const auto problem = problem_of(quick_return(0.01), design_of(slide_and_crank, asked));
        const auto at = problem.evaluate(description::values_of(problem.design().parameters));
        CHECK_FALSE(at.usable);
        CHECK(std::isnan(at.objective));
        return at.reason;
    };
    const std::string far =
        reason(R"({"type": "event_time", "name": "far", "of": "slide", "threshold": 200, "direction": "rising", "lower": 0})");
    CAPTURE(far);
    CHECK(far.find("`far`") != std::string::npos);
    CHECK(far.find("`slide` crosses 200 mm rising at no time in this motion") != std::string::npos);
    CHECK(far.find("03 s, with 118.3 mm") != std::string::npos);
    const std::string third = reason(R"({"type": "event_time", "of": "slide", "threshold": 100, "occurrence": 5, "lower": 0})");
    CHECK(third.find("crosses 100 mm 3 times") != std::string::npos);
    CHECK(third.find("no fifth") != std::string::npos);
    const std::string part = reason(R"({"type": "value_at", "of": "slide", "time": "again + 1 s", "lower": 0})");
    CHECK(part.find("is no time that this is known at: from 0 s to 1.3 s") != std::string::npos);
    const std::string rests = reason(R"({"type": "time_share", "of": "max(slide, 100 mm) ", "above": 100, "lower": 0})");
    CHECK(rests.find("rests on 100 mm") != std::string::npos);
    const std::string still = reason(R"({"type": "time_share", "of": "slide", "above": 100, "along": "0 * slide", "lower": 0})");
    CHECK(still.find("does not get on") != std::string::npos);
    const std::string odd = reason(R"({"type": "event_time", "of": "sqrt((100 mm - slide) / 1 mm) ", "threshold": 1, "lower": 0})");
    CHECK(odd.find("not a finite number at the start") != std::string::npos);
}

TEST_CASE("events: a formula of one that does not happen is no number either, whichever side it takes", "[event_test]") {
    const std::string more = std::string(slide_and_crank) + R"(, "never": {"type": "event_time", "of": "slide", "threshold": 500})";
    const auto problem = problem_of(quick_return(0.01), design_of(more, bound("if(never < 1 s, never, inner)", "either")));
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    CHECK_FALSE(at.usable);
    CHECK(at.reason.find("crosses 500 mm at no time") != std::string::npos);
}

TEST_CASE("events: what is about to come or go is told", "[event_test]") {
    const auto told = [](const std::string& asked) {
        const auto problem = problem_of(quick_return(0.01), design_of(slide_and_crank, asked));
        const auto at = evaluated(problem);
        const auto sentences = problem::motion_warnings(problem.design(), at);
        return sentences.empty() ? std::string() : sentences.front();
    };
    CHECK(told(R"({"type": "event_time", "of": "slide", "threshold": 100, "lower": 0})").empty());
    CHECK(told(bound("ratio", "ratio")).empty());
    // 0.2 mm below the outer end: crossed, and crossed back at once.
    const std::string slight = told(R"({"type": "event_time", "of": "slide", "threshold": 118.1, "direction": "falling", "lower": 0})");
    CHECK(slight.find("it turns round no more than") != std::string::npos);
    CHECK(slight.find("at 0.03 s") != std::string::npos);
    const std::string early = told(R"({"type": "event_time", "of": "slide", "threshold": "117.85mm", "lower": 0})");
    CAPTURE(early, slight);
    CHECK(early.find("within a step of the motion's start") != std::string::npos);
}

TEST_CASE("events: what cannot be is refused by name", "[event_test]") {
    const auto messages = [](const std::string& quantity) {
        const tests::support::TemporaryFolder folder;
        folder.write("small.scene.json", quick_return(0.01));
        const std::string more = std::string(slide_and_crank) +
                                 R"(, "most": {"type": "marker_position", "body": "slide", "point": [0, 0, 0],
            "axis": [1, 0, 0], "over": "largest"}, "weight": {"type": "mass", "bodies": ["rod"]}, "asked": {)" +
                                 quantity + "}";
        auto file = reading::parse_design(design_of(more, R"({"type": "expression", "expression": "weight", "lower": 0})"),
                                          folder.file("small.design.json"));
        Errors errors = file.errors();
        if (file) {
            for (const auto& named : file->quantities)
                if (named.name == "asked") file->design.constraints.front().quantity = named.quantity;
            errors = problem::DesignProblem::create(std::move(file->design)).errors();
        }
        std::string all;
        for (const Error& error : errors) all += error.where + ": " + error.message + "\n";
        return all;
    };
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"("type": "event_time")", "of"},
        {R"("type": "event_time", "of": "slid")", "slide"},
        {R"("type": "event_time", "of": 3)", "of"},
        {R"("type": "event_time", "of": "weight")", "is no quantity that each instant has a number of"},
        {R"("type": "event_time", "of": "outer")", "is no quantity that each instant has a number of"},
        {R"("type": "event_time", "of": "most")", "is one number"},
        {R"("type": "event_time", "of": "slide", "threshold": "3 N")", "threshold"},
        {R"("type": "event_time", "of": "slide", "threshold": "nan")", "threshold"},
        {R"("type": "event_time", "of": "slide", "threshold": "= r / 0")", "threshold"},
        {R"("type": "event_time", "of": "slide", "threshold": "= q")", "q"},
        {R"("type": "event_time", "of": "slide", "direction": "up")", "rising"},
        {R"("type": "event_time", "of": "slide", "occurrence": 0)", "0 is none"},
        {R"("type": "event_time", "of": "slide", "occurrence": 1.5)", "occurrence"},
        {R"("type": "event_time", "of": "slide", "derivative": 3)", "derivative"},
        {R"("type": "event_time", "of": "slide", "from": 5)", "not within the motion"},
        {R"("type": "event_time", "of": "slide", "from": 0.5, "to": 0.5)", "begins before it ends"},
        {R"("type": "event_time", "of": "slide", "over": "largest")", "over"},
        {R"("type": "value_at", "of": "slide")", "time"},
        {R"("type": "value_at", "of": "slide", "time": "crank")", "the time of an event is wanted"},
        {R"("type": "value_at", "of": "slide", "time": "late")", "late"},
        {R"("type": "time_share", "of": "slide")", "say one of them"},
        {R"("type": "time_share", "of": "slide", "above": 1, "below": 2)", "say one of them"},
        {R"("type": "time_share", "of": "slide", "above": "30deg")", "above"},
        {R"("type": "time_share", "of": "slide", "above": 1, "along": "most")", "is one number"},
        {R"("type": "gap", "a": "crank", "b": "crank")", "the same"},
        {R"("type": "gap", "a": "crank", "b": "rod")", "never collide"},
        {R"("type": "gap", "a": "crank", "b": "rodd")", "rod"},
        {R"("type": "largest", "of": [])", "at least one"},
        {R"("type": "largest", "of": ["slide", "crank"])", "one dimension"},
        {R"("type": "least", "of": ["slide", "nothing"])", "nothing"},
        {R"("type": "least", "of": "slide")", "of"},
        {R"("type": "expression", "expression": "asked + slide")", "cannot follow from itself"},
        {R"("type": "value_at", "of": "slide", "time": "asked")", "cannot follow from itself"},
    };
    for (const auto& [quantity, message] : cases) {
        const std::string told = messages(quantity);
        CAPTURE(quantity, told);
        CHECK(told.find(message) != std::string::npos);
    }
    CHECK(messages(R"("type": "event_time", "of": "slide", "threshold": 100)").empty());
}

TEST_CASE("events: named expressions that name each other without end are refused at once", "[event_test]") {
    std::string quantities = std::string(slide_and_crank) + R"(, "q0": {"type": "expression", "expression": "slide"},
        "q1": {"type": "expression", "expression": "2 * slide"})";
    for (int k = 2; k < 60; ++k)
        quantities += ", \"q" + std::to_string(k) + R"(": {"type": "expression", "expression": "q)" + std::to_string(k - 1) + " + q" +
                      std::to_string(k - 2) + "\"}";
    const tests::support::TemporaryFolder folder;
    folder.write("small.scene.json", quick_return(0.01));
    const auto file = reading::parse_design(design_of(quantities, bound("ratio", "ratio")), folder.file("small.design.json"));
    REQUIRE_FALSE(file);
    CHECK(file.errors().front().message.find("times over") != std::string::npos);
}

}  // namespace fettle::design::quantities::event_test
