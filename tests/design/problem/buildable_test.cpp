// SPDX-License-Identifier: MIT
#include "design/problem/buildable.hpp"

#include <catch2/catch.hpp>

#include "tests/design/small_problem.hpp"

namespace fettle::design::problem::buildable_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;

// The cube, half of whose 20 mm lie before its middle, reaches the wall at 37.5 mm when its place is 27.5 mm.
std::string with_wall_in_reach() { return replaced(small_design, "\"lower\": -5, \"upper\": 20", "\"lower\": -5, \"upper\": 43"); }

}  // namespace

TEST_CASE("bounds within which everything can be made are not spoken of") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const BoundsReport report = try_bounds(problem);
    CHECK(report.unreachable.empty());
    CHECK(report.samples == 40);
    CHECK(report.refused == 0);
    CHECK(described(problem.design(), report).empty());
}

TEST_CASE("how far a parameter can go is found to a thousandth of the way") {
    const DesignFolder folder(with_wall_in_reach());
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    const Reach wall = reach(problem, p, 2, 0.043);
    CHECK(wall.value <= 0.0275);
    CHECK(wall.value > 0.0275 - 40e-6);
    REQUIRE(wall.obstacles.size() == 1);
    CHECK(wall.obstacles[0].code == ErrorCode::bodies_intersect);
    VectorX there = p;
    there[2] = wall.value;
    CHECK(problem.obstacles(there).empty());
    there[2] = wall.value + 41e-6;
    CHECK_FALSE(problem.obstacles(there).empty());
    const Reach free = reach(problem, p, 2, -0.005);
    CHECK(free.value == -0.005);
    CHECK(free.obstacles.empty());
}

TEST_CASE("what lies between, too: a way through a wall ends before it") {
    // 70 mm is beyond the wall, in the open.
    const DesignFolder folder(replaced(small_design, "\"lower\": -5, \"upper\": 20", "\"lower\": -5, \"upper\": 75"));
    const DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    const Reach wall = reach(problem, p, 2, 0.07);
    CHECK(wall.value == Approx(0.0275).margin(70e-6));
    p[2] = 0.07;
    CHECK(problem.obstacles(p).empty());
}

TEST_CASE("dimensions within the bounds that make no part, and parts that intersect, are found without a simulation") {
    const DesignFolder folder(replaced(with_wall_in_reach(), "\"lower\": 6, \"upper\": 14", "\"lower\": -2, \"upper\": 14"));
    const DesignProblem problem = problem_of(folder);
    const BoundsReport report = try_bounds(problem);
    REQUIRE(report.unreachable.size() == 2);
    CHECK(report.unreachable[0].parameter == 0);
    CHECK(report.unreachable[0].bound == -0.002);
    CHECK(report.unreachable[0].reach.value == Approx(0).margin(12e-6));
    CHECK(report.unreachable[1].parameter == 2);
    CHECK(report.refused > 5);
    CHECK(report.refused < report.samples);
    REQUIRE(report.obstacles.size() == 2);
    CHECK(report.obstacles[0].designs + report.obstacles[1].designs == report.refused);
    CHECK(report.obstacles[0].designs >= report.obstacles[1].designs);
    const auto lines = described(problem.design(), report);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0].find("`height` below") == 0);
    CHECK(lines[0].find("body cube: box/size_z") != std::string::npos);
    CHECK(lines[1].find("`place` above 27.4") == 0);
    CHECK(lines[1].find("its bound is 43 mm") != std::string::npos);
    CHECK(lines[2].find(std::to_string(report.refused) + " of 40 designs spread over the bounds cannot be made") == 0);
    CHECK(described(problem.design(), try_bounds(problem)) == lines);
}

TEST_CASE("what an inequality between parameters excludes is not held against the bounds, what an equation does is tried all the same") {
    const std::string relation = R"x("constraints": [ { "type": "relation", "expression": "place + width / 2", "upper": "37 mm" },)x";
    const DesignFolder folder(replaced(with_wall_in_reach(), "\"constraints\": [", relation));
    const DesignProblem problem = problem_of(folder);
    const BoundsReport report = try_bounds(problem);
    CHECK(report.unreachable.empty());
    CHECK(report.samples < 40);
    CHECK(report.samples > 10);
    CHECK(report.refused == 0);

    const std::string equation =
        R"x("constraints": [ { "type": "relation", "expression": "place + width / 2", "lower": 13, "upper": 13 },)x";
    const DesignFolder other(replaced(with_wall_in_reach(), "\"constraints\": [", equation));
    CHECK(try_bounds(problem_of(other)).unreachable.size() == 1);
}

TEST_CASE("obstacles are counted by their place, the commonest first") {
    const auto one = [](const char* where) { return Errors{{ErrorCode::out_of_range, where, "so"}, {ErrorCode::parse, "x", "never"}}; };
    const auto counted = tally({one("a"), {}, one("b"), one("c"), one("b"), one("c")});
    REQUIRE(counted.size() == 3);
    CHECK(counted[0].where == "b");
    CHECK(counted[0].designs == 2);
    CHECK(counted[1].where == "c");
    CHECK(counted[2].designs == 1);
}

}  // namespace fettle::design::problem::buildable_test
