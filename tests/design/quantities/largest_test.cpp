// SPDX-License-Identifier: MIT
// The largest of many, over steps, quantities and scenarios: its branches, and that a search with them ends where no maximum that is
// differentiated at one place could lead it.
#include <catch2/catch.hpp>
#include <cmath>

#include "design/optimisers/optimisation.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "design/quantities/extreme.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/quantities/file_problem.hpp"

namespace fettle::design::quantities::largest_test {

namespace {

using optimisers::OptimiserStatus;
using tests::design_support::problem_of;

// A bar that turns, for designs that are about formulas of the time and their parameters.
const char* turning_bar = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.02, "end_time": 1, "gravity": [0, 0, 0],
    "bodies": [{"name": "bar", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}}],
    "joints": [{"name": "pivot", "type": "revolute", "b": "bar", "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "motors": [{"name": "drive", "joint": "pivot", "angle": {"rate": 60}}]})";

// How far t^2 is from a + b t. The best line has the same error at 0, 1/2 and 1: 1/8 (Chebyshev).
const char* off_a_line = R"("expression": "(time / 1 s)^2 - a - b * time / 1 s", "name": "off", )";

std::string design_of(const std::string& rest) {
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "a", "value": 0.3, "lower": -1, "upper": 1, "unit": "1"}, {"name": "b", "value": 0.1, "lower": -1, "upper": 2, "unit": "1"}], )" +
           rest + "}";
}

studies::OptimiseOutcome optimised(const problem::DesignProblem& problem) {
    auto outcome = studies::optimise_design(problem);
    for (const Error& error : outcome.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(outcome);
    UNSCOPED_INFO(outcome->report.message << ", " << outcome->report.evaluations << " evaluations, at "
                                          << outcome->report.point.transpose());
    return std::move(outcome).value();
}

// What optimisers see where the largest is differentiated at one place alone.
optimisers::Problem without_branches(const problem::DesignProblem& problem) {
    optimisers::Problem blind = problem::optimiser_problem(problem);
    blind.evaluate = [inner = blind.evaluate](const VectorX& p) {
        optimisers::Evaluation e = inner(p);
        e.objective_branches = e.constraint_branches = {};
        return e;
    };
    return blind;
}

}  // namespace

TEST_CASE("largest: the maxima of a sequence, the largest first, each smooth", "[largest_test]") {
    const auto places = [](const std::vector<double>& y) {
        std::vector<int> out;
        for (const Extreme& extreme : smooth_maxima(y)) out.push_back(extreme.first + 2);
        return out;
    };
    CHECK(places({1, 3, 2, 4, 0, 5}) == std::vector<int>{5, 3, 1});
    CHECK(places({2, 2, 1, 2, 2}) == std::vector<int>{0, 3});
    CHECK(places({0, 1, 1, 2}) == std::vector<int>{3});
    CHECK(places({0, 1, 1, 0}) == std::vector<int>{1});
    CHECK(places({7}) == std::vector<int>{0});
    CHECK(places({3, 3, 3}) == std::vector<int>{0});
}

TEST_CASE("largest: rows for each place where the steps have an extreme, with derivatives of their own", "[largest_test]") {
    const auto problem = problem_of(turning_bar, design_of(R"("objective": [{"type": "expression", )" + std::string(off_a_line) +
                                                           R"("over": "peak"}], "constraints": [{"type": "expression", )" + off_a_line +
                                                           R"("over": "largest", "upper": 0.5}, {"type": "expression", )" + off_a_line +
                                                           R"("over": "least", "lower": -0.5}])"));
    VectorX p(2);
    p << -0.12, 0.98;
    const auto at = problem.evaluate(p);
    REQUIRE(at.usable);
    // At 0, at 1, and where t = b/2: 0.12, 0.14, and minus 0.1201.
    REQUIRE(at.objective_branches.of.size() == 3);
    CHECK(at.objective_branches.values[0] == Approx(0.14));
    CHECK(at.objective_branches.values.minCoeff() == Approx(0.12));
    CHECK((at.objective_branches.values.array() - (0.98 * 0.98 / 4 - 0.12)).abs().minCoeff() < 1e-12);
    REQUIRE(at.constraint_branches.of == std::vector<int>{0});
    CHECK(at.constraints[0].value == Approx(0.14));
    CHECK(at.constraint_branches.values[0] == Approx(0.12));
    const double h = 1e-6;
    for (Eigen::Index j = 0; j < 3; ++j)
        for (int k = 0; k < 2; ++k) {
            const auto branch = [&](double step) {
                VectorX q = p;
                q[k] += step;
                return problem.evaluate(q).objective_branches.values[j];
            };
            CHECK(at.objective_branches.jacobian(j, k) == Approx((branch(h) - branch(-h)) / (2 * h)).margin(1e-7));
        }
}

TEST_CASE("largest: the best line through a parabola, whose peak has three places", "[largest_test]") {
    const auto problem =
        problem_of(turning_bar, design_of(R"("objective": [{"type": "expression", )" + std::string(off_a_line) + R"("over": "peak"}])"));
    const auto outcome = optimised(problem);
    CHECK(outcome.report.status == OptimiserStatus::optimal);
    CHECK(outcome.report.point[0] == Approx(-0.125).margin(1e-4));
    CHECK(outcome.report.point[1] == Approx(1).margin(2e-4));
    CHECK(outcome.final.objective == Approx(0.125).margin(2e-5));
    CHECK(outcome.report.evaluations <= 20);

    const auto optimiser = optimisers::make_optimiser("sqp");
    optimisers::OptimiserOptions options;
    options.max_evaluations = 40;
    const auto blind = optimisers::optimise(without_branches(problem), **optimiser, options);
    INFO(blind.message << ", " << blind.evaluations << " evaluations, at " << blind.point.transpose());
    CHECK((blind.status != OptimiserStatus::optimal || blind.evaluations > 2 * outcome.report.evaluations));
}

TEST_CASE("largest: a bound on the peak holds at each of its places", "[largest_test]") {
    // The steepest line that stays within 0.2: at 0 it is 0.2 above, and a - b^2/4 = -0.2 where it touches: b = sqrt(1.6).
    const auto problem = problem_of(
        turning_bar,
        design_of(R"("objective": [{"type": "expression", "expression": "b", "weight": -1}], "constraints": [{"type": "expression", )" +
                  std::string(off_a_line) + R"("over": "peak", "upper": 0.2}])"));
    const auto outcome = optimised(problem);
    CHECK(outcome.report.status == OptimiserStatus::optimal);
    CHECK(outcome.report.point[0] == Approx(-0.2).margin(1e-3));
    CHECK(outcome.report.point[1] == Approx(std::sqrt(1.6)).margin(1e-3));
    CHECK(outcome.final.constraints[0].value <= 0.2);
    CHECK(outcome.report.evaluations <= 30);
}

TEST_CASE("largest: of named quantities, as an objective and as a bound", "[largest_test]") {
    const std::string quantities = R"("quantities": {"near": {"type": "expression", "expression": "(a - 0.5)^2 + (b - 0.2)^2"},
        "far": {"type": "expression", "expression": "(a + 0.5)^2 + (b - 0.2)^2"},
        "both": {"type": "largest", "of": ["near", "far"]}}, )";
    const auto minimised = problem_of(turning_bar, design_of(quantities + R"("objective": [{"type": "largest", "of": ["near", "far"]}])"));
    const auto outcome = optimised(minimised);
    CHECK(outcome.report.status == OptimiserStatus::optimal);
    CHECK(outcome.final.objective == Approx(0.25).margin(1e-4));
    CHECK(outcome.report.point[0] == Approx(0).margin(1e-4));
    CHECK(outcome.report.point[1] == Approx(0.2).margin(2e-2));
    CHECK(outcome.report.evaluations <= 30);

    // Within both circles b is largest where they meet.
    const auto bounded =
        problem_of(turning_bar, design_of(quantities + R"("objective": [{"type": "expression", "expression": "b", "weight": -1}],
        "constraints": [{"type": "largest", "of": ["near", "far"], "upper": 1}])"));
    const auto corner = optimised(bounded);
    CHECK(corner.report.status == OptimiserStatus::optimal);
    CHECK(corner.report.point[0] == Approx(0).margin(1e-3));
    CHECK(corner.report.point[1] == Approx(0.2 + std::sqrt(0.75)).margin(1e-3));

    const auto least =
        problem_of(turning_bar, design_of(quantities + R"("objective": [{"type": "least", "of": ["-near", "-far"], "weight": -1}])"));
    CHECK(optimised(least).final.objective == Approx(0.25).margin(1e-4));

    // Named once, and used in another formula: the number is the same.
    const auto named =
        problem_of(turning_bar, design_of(quantities + R"("objective": [{"type": "expression", "expression": "2 * both"}])"));
    const auto at = named.evaluate(description::values_of(named.design().parameters));
    REQUIRE(at.usable);
    CHECK(at.objective == Approx(2 * std::max(0.04 + 0.01, 0.64 + 0.01)));
}

TEST_CASE("largest: over scenarios, as a bound that both hold", "[largest_test]") {
    // The bar turns by 60 degrees in the one and by -30 in the other: 60 - a, and a + 30, in degrees.
    const std::string design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "a", "value": 20, "lower": 0, "upper": 90, "unit": "deg"}],
        "scenarios": [{"name": "far"}, {"name": "near", "set": {"/motors/drive/angle/rate": -30}}],
        "quantities": {"turn": {"type": "turn", "body": "bar", "axis": [0, 0, 1]},
                       "out": {"type": "expression", "expression": "turn - a", "scenario": "far"},
                       "back": {"type": "expression", "expression": "a - turn", "scenario": "near"}},
        "objective": [{"type": "largest", "of": ["out", "back"], "name": "worse"}],
        "constraints": [{"type": "largest", "of": ["out", "back"], "upper": "90deg"}]})";
    const auto problem = problem_of(turning_bar, design);
    const auto at = problem.evaluate(description::values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    const double degree = M_PI / 180;
    CHECK(at.constraints[0].value == Approx(50 * degree));
    CHECK(at.jacobian(0, 0) == Approx(1));
    REQUIRE(at.constraint_branches.of.size() == 1);
    CHECK(at.constraint_branches.values[0] == Approx(40 * degree));
    CHECK(at.constraint_branches.jacobian(0, 0) == Approx(-1));
    const auto outcome = optimised(problem);
    CHECK(outcome.report.status == OptimiserStatus::optimal);
    CHECK(outcome.final.constraints[0].value == Approx(45 * degree).epsilon(1e-4));
    CHECK(outcome.report.point[0] == Approx(15 * degree).margin(1e-3));
}

}  // namespace fettle::design::quantities::largest_test
