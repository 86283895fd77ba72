// SPDX-License-Identifier: MIT
#include "design/studies/limits.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "design/studies/optimise_design.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::studies::limits_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;

// The small design, whose cube is wanted next to the wall (play at most `upper` mm), its place bounded by `most` mm.
std::string wanted_near(const std::string& upper, const std::string& most) {
    const std::string bounded = replaced(small_design, "\"lower\": -5, \"upper\": 20", "\"lower\": -5, \"upper\": " + most);
    const size_t begin = bounded.find("\"constraints\": ["), end = bounded.find("\"optimiser\"");
    return bounded.substr(0, begin) + R"("constraints": [{ "type": "play", "a": "cube", "b": "wall", "upper": )" + upper + " }],\n" +
           bounded.substr(end);
}

struct Case {
    problem::DesignProblem problem;
    VectorX p;
    problem::DesignEvaluation at;
};

Case at_place(const DesignFolder& folder, double place) {
    problem::DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    p[2] = place;
    problem::DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    REQUIRE(at.violation > 0);
    return {std::move(problem), std::move(p), std::move(at)};
}

bool any(const std::vector<std::string>& lines, const std::string& words) {
    for (const std::string& line : lines) {
        if (line.find(words) != std::string::npos) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("where parts cannot be made they limit the design, not the requirement") {
    const DesignFolder folder(wanted_near("0.001", "43"));
    const Case c = at_place(folder, 0.0273);
    const auto lines = limits_of(c.problem, c.p, c.at, c.at.jacobian, {}, 7);
    REQUIRE(lines.size() >= 1);
    CHECK(any(lines, "parameter place can go no further than 27.4"));
    CHECK(any(lines, "though its bound is 43 mm: `cube` and `wall` intersect"));
    CHECK_FALSE(any(lines, "required is"));

    // Failed trials alone say so too, each with its reason, and apart from those that failed in the simulation.
    VectorX inside = c.p, free = c.p;
    inside[2] = 0.035;
    free[2] = 0.01;
    const auto failed = limits_of(c.problem, c.p, c.at, {}, {{inside, "-"}, {inside, "-"}, {free, "step 3: blocked"}}, 7);
    CHECK(any(failed, "2 of 7 trials failed, `cube` and `wall` intersect"));
    CHECK(any(failed, "1 of 7 trials failed, in the simulation: step 3: blocked"));
    CHECK_FALSE(any(failed, "required is"));
}

TEST_CASE("where a bound limits the design it is told, with the requirement; other parameters' bounds are not") {
    const DesignFolder folder(wanted_near("0.001", "20"));
    Case c = at_place(folder, 0.02);
    c.p[4] = c.problem.design().parameters[4].lower;  // the speed has no part in it
    const auto lines = limits_of(c.problem, c.p, c.at, c.at.jacobian, {}, 7);
    CHECK(any(lines, "parameter place is at its upper bound 20 mm"));
    CHECK_FALSE(any(lines, "speed"));
    CHECK(any(lines, "play cube:wall: proven 7."));
    // The trials that failed in the simulation do not change that.
    CHECK(any(limits_of(c.problem, c.p, c.at, c.at.jacobian, {{c.p, "step 3: blocked"}}, 7), "required is"));
}

TEST_CASE("a run tells of parts that cannot be made before it simulates, and blames them at its end") {
    // 0 mm of play can only be reached through the wall.
    const DesignFolder folder(replaced(wanted_near("0", "43"), "\"max_evaluations\": 8", "\"max_evaluations\": 4"));
    const problem::DesignProblem problem = problem_of(folder);
    std::vector<std::string> told;
    OptimiseOptions options;
    options.narrate = [&](const std::string& line) { told.push_back(line); };
    const auto outcome = optimise_design(problem, options);
    REQUIRE(outcome);
    REQUIRE(told.size() > 2);
    CHECK(told[0].find("bounds: `place` above 27.4") == 0);
    CHECK(outcome->unbuildable.size() == 2);
    CHECK_FALSE(outcome->report.feasible);
    for (const std::string& line : outcome->limits) UNSCOPED_INFO(line);
    CHECK(any(outcome->limits, "`cube` and `wall` intersect"));
    CHECK_FALSE(any(outcome->limits, "required is"));
}

TEST_CASE("a requirement that no parameter moves is told before the search, and at its end instead of a parameter's bound") {
    // A block that is pulled against the stop of its slide at once: its travel hardly follows from its mass.
    const std::string scene = R"({ "fettle_scene": 1, "units": "mm", "timestep": 0.005, "end_time": 0.2, "gravity": [0, 0, 0],
        "contact": { "dhat": 0.5 },
        "bodies": [{ "name": "block", "density": 1000, "shape": { "part": "box", "dimensions": { "size_x": 10 } } }],
        "joints": [{ "name": "slide", "type": "prismatic", "b": "block", "point": [0, 0, 0], "axis": [1, 0, 0], "limits": [-1, 4], "damping": 2 }],
        "loads": [{ "name": "pull", "body": "block", "point": [0, 0, 0], "force": [1, 0, 0] }] })";
    const std::string design = R"({ "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{ "name": "size", "value": 10, "lower": 5, "upper": 20 }],
        "set": { "/bodies/block/shape/dimensions/size_x": "= size" },
        "objective": [{ "type": "mass", "bodies": ["block"], "weight": 1 }],
        "constraints": [{ "type": "stroke", "name": "travel", "body": "block", "axis": [1, 0, 0], "lower": 8 }],
        "optimiser": { "max_evaluations": 12 } })";
    const DesignFolder folder(design, scene);
    const problem::DesignProblem problem = problem_of(folder);
    std::vector<std::string> told;
    OptimiseOptions options;
    options.narrate = [&](const std::string& line) { told.push_back(line); };
    const auto outcome = optimise_design(problem, options);
    REQUIRE(outcome);
    for (const std::string& line : told) UNSCOPED_INFO(line);
    for (const std::string& line : outcome->limits) UNSCOPED_INFO(line);
    const std::string words = "constraint `travel`: it is ";
    const auto starts_with = [&](const std::string& begin) {
        return std::find_if(told.begin(), told.end(), [&](const std::string& line) { return line.find(begin) == 0; });
    };
    const auto warning = starts_with("warning: " + words);
    REQUIRE(warning != told.end());
    CHECK(warning < std::find_if(
                        told.begin(), told.end(), [](const std::string& line) { return line.find("objective") != std::string::npos; }));
    CHECK(warning->find("a joint at its stop (`slide` may reach one)") != std::string::npos);
    CHECK(outcome->at_start.warnings.size() == 1);
    CHECK_FALSE(outcome->report.feasible);
    CHECK(any(outcome->limits, words));
    CHECK_FALSE(any(outcome->limits, "parameter size"));
}

}  // namespace fettle::design::studies::limits_test
