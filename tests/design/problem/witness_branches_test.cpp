// SPDX-License-Identifier: MIT
#include "design/problem/witness_branches.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/optimisers/optimisation.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "design/quantities/clearance.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/pin_in_bore.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::problem::witness_branches_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;

DesignProblem bore(const std::string& x, const std::string& y, const std::string& sums) {
    return problem_of(DesignFolder(bore_design(x, y, sums), bore_scene));
}

// The least of a function and its branches, linearised.
double predicted(double value, const VectorX& gradient, const optimisers::Branches& branches, const VectorX& step) {
    double least = value + gradient.dot(step);
    for (Eigen::Index k = 0; k < branches.values.size(); ++k)
        least = std::min(least, branches.values[k] + branches.jacobian.row(k).dot(step));
    return least;
}

}  // namespace

TEST_CASE("branches that cannot become the least within the ranges say nothing") {
    const VectorX ranges = Vector2(1, 2);
    MatrixX jacobian(5, 2);
    jacobian << 1, 0,  // the first
        1, 0,          // the same
        -1, 0,         // falls where the first rises
        0, 0.2,        // can fall by 1.4 beside the first, and is 2 more
        -1, 1e-7;      // the third once more
    VectorX values(5);
    values << 1, 1, 1.5, 3, 1.5;
    CHECK(telling_branches(values, jacobian, ranges) == std::vector<int>{2});
    values[3] = 2.3;
    CHECK(telling_branches(values, jacobian, ranges) == std::vector<int>{2, 3});
    CHECK(telling_branches(VectorX::Constant(1, 1.0), jacobian.topRows(1), ranges).empty());
}

TEST_CASE("a pin in its bore has rows all round: no step is promised what another witness takes") {
    const DesignProblem problem = bore("0", "0", least_play);
    for (const Vector2& place : {Vector2(0, 0), Vector2(1e-4, 0.5e-4), Vector2(-0.2e-4, 1.7e-4)}) {
        VectorX p = values_of(problem.design().parameters);
        p.head<2>() = place;
        const DesignEvaluation at = problem.evaluate(p);
        REQUIRE(at.usable);
        CAPTURE(place.transpose(), at.constraints[0].value, at.constraint_branches.values.transpose());
        REQUIRE(at.constraint_branches.of.size() >= 2);
        CHECK(at.constraint_branches.of.size() < static_cast<size_t>(quantities::Clearance::most_branches_at_rest));
        for (int k = 0; k < 24; ++k) {
            const double angle = 2 * M_PI * k / 24;
            VectorX step = VectorX::Zero(3);
            step.head<2>() = 1.5e-4 * Vector2(std::cos(angle), std::sin(angle));
            EvaluateOptions values_only;
            values_only.gradients = false;
            const double seen = problem.evaluate(p + step, values_only).constraints[0].value;
            const VectorX own = at.jacobian.row(0).transpose();
            const double told = predicted(at.constraints[0].value, own, at.constraint_branches, step);
            // Distances of two features are convex: linearised they are too small by up to step^2 / (2 gap), 0.03 mm here.
            CHECK(told >= seen - 0.3e-4);
            CHECK(told <= seen + 0.5e-4);
        }
    }
}

TEST_CASE("a parameter that moves all witnesses alike needs no rows") {
    const DesignFolder folder(bore_design("0", "0", least_play), bore_scene);
    description::Design design = file_of(folder).design;
    design.parameters.erase(design.parameters.begin(), design.parameters.begin() + 2);
    std::erase_if(design.numbers, [](const auto& number) { return number.formula.inputs != std::vector<std::string>{"radius"}; });
    const auto problem = DesignProblem::create(design);
    REQUIRE(problem);
    const DesignEvaluation at = problem->evaluate(values_of(design.parameters));
    REQUIRE(at.usable);
    CHECK(at.constraint_branches.of.empty());
    EvaluateOptions tied;
    tied.branches = BranchReach::tied;
    CHECK(problem->evaluate(values_of(design.parameters), tied).ties.empty());
}

TEST_CASE("ties are told: of a centred pin, and of none that stands aside") {
    for (const char* sums : {large_play, least_play}) {
        const DesignProblem problem = bore("0", "0", sums);
        VectorX p = values_of(problem.design().parameters);
        EvaluateOptions tied;
        tied.branches = BranchReach::tied;
        const DesignEvaluation centred = problem.evaluate(p, tied);
        REQUIRE(centred.ties.size() == 1);
        const Tie& tie = centred.ties[0];
        CHECK(tie.of_objective == (std::string(sums) == large_play));
        CHECK(tie.branches >= 3);
        for (int k = 0; k < 2; ++k) {
            CHECK(tie.least[k] < -0.5);
            CHECK(tie.greatest[k] > 0.5);
        }
        CHECK(tie.least[2] == Approx(tie.greatest[2]).epsilon(1e-3));
        CHECK(centred.constraint_branches.of.empty());
        p.head<2>() = Vector2(1e-4, 0.3e-4);
        CHECK(problem.evaluate(p, tied).ties.empty());
    }
}

TEST_CASE("the largest play is found in the middle of the bore, and called optimal there") {
    const DesignProblem problem = bore("0.17", "-0.09", large_play);
    const auto outcome = studies::optimise_design(problem);
    REQUIRE(outcome);
    const optimisers::OptimiserReport& report = outcome->report;
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == optimisers::OptimiserStatus::optimal);
    CHECK(report.point.head<2>().norm() < 2e-6);
    CHECK(report.point[2] == Approx(4.9e-3).epsilon(1e-12));
    CHECK(report.evaluations <= 15);

    // With the derivative of one witness alone no such thing can be told.
    optimisers::Problem blind = optimiser_problem(problem);
    blind.evaluate = [inner = blind.evaluate](const VectorX& p) {
        optimisers::Evaluation e = inner(p);
        e.objective_branches = e.constraint_branches = {};
        return e;
    };
    const auto optimiser = optimisers::make_optimiser("sqp");
    optimisers::OptimiserOptions options;
    options.max_evaluations = 60;
    const auto without = optimisers::optimise(blind, **optimiser, options);
    INFO(without.message << ", " << without.evaluations << " evaluations, at " << without.point.transpose());
    CHECK((without.status != optimisers::OptimiserStatus::optimal || without.evaluations > 2 * report.evaluations));
}

TEST_CASE("the thickest pin of a least play stands in the middle of its bore") {
    const DesignProblem problem = bore("0.03", "-0.02", least_play);
    const auto outcome = studies::optimise_design(problem);
    REQUIRE(outcome);
    const optimisers::OptimiserReport& report = outcome->report;
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == optimisers::OptimiserStatus::optimal);
    CHECK(report.point[2] == Approx(5.02e-3).epsilon(1e-12));
    CHECK(report.point.head<2>().norm() < 3e-6);  // nowhere else does it have 0.4 mm all round
    CHECK(outcome->final.constraints[0].lower >= 0.4e-3);
    CHECK(report.evaluations <= 12);
}

namespace {

// A bar that turns wholly about its middle in a window of 80 x 40 mm; how long it is, and where the pivot stands, is free.
const char* window_scene = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.01,
  "variables": { "length": "24mm", "x": "2mm", "y": "3mm" },
  "bodies": [
    { "name": "frame", "type": "static", "group": "apart",
      "shape": { "profiles": { "frame": { "holes": { "rectangle": [80, 40] }, "in": { "rectangle": [100, 60] } } },
                 "solid": { "extrude": "frame", "to": "6mm" } } },
    { "name": "bar", "density": 1000, "group": "apart", "position": ["= x", "= y", 1],
      "shape": { "profiles": { "bar": { "rectangle": ["= length", 4] } }, "solid": { "extrude": "bar", "to": "4mm" } } }
  ],
  "joints": [{ "name": "pivot", "type": "revolute", "b": "bar", "point": ["= x", "= y", 1], "axis": [0, 0, 1] }]
})";
const char* window_design = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [{ "name": "length", "lower": 20, "upper": 40 }, { "name": "x", "lower": -10, "upper": 10 },
                 { "name": "y", "lower": -8, "upper": 8 }],
  "objective": [{ "type": "expression", "name": "length", "expression": "length / 1mm", "weight": -1 }],
  "constraints": [{ "type": "clearance", "a": "bar", "b": "frame", "minimum": 1, "ranges": true }],
  "optimiser": { "name": "sqp", "max_evaluations": 40 }
})";

}  // namespace

TEST_CASE("the longest bar that turns in a window stands in the middle of it: walls that share a clearance over ranges are all seen") {
    const DesignProblem problem = problem_of(DesignFolder(window_design, window_scene));
    const DesignEvaluation at = problem.evaluate(Vector3(37.5e-3, 1e-3, 0.2e-3));
    REQUIRE(at.usable);
    REQUIRE(at.constraint_branches.of.size() >= 1);
    CHECK(at.jacobian(0, 2) == Approx(-1).epsilon(1e-6));
    const VectorX by_y = at.constraint_branches.jacobian.col(2);
    CHECK(by_y.maxCoeff() == Approx(1).epsilon(1e-6));  // of the lower wall
    const auto outcome = studies::optimise_design(problem);
    REQUIRE(outcome);
    const optimisers::OptimiserReport& report = outcome->report;
    INFO(report.message << ", " << report.evaluations << " evaluations, at " << report.point.transpose());
    CHECK(report.status == optimisers::OptimiserStatus::optimal);  // within the 40 evaluations that the design allows
    CHECK(report.point[0] == Approx(2 * std::sqrt(19e-3 * 19e-3 - 2e-3 * 2e-3)).epsilon(3e-4));
    CHECK(std::abs(report.point[2]) < 5e-6);
    CHECK(outcome->final.constraints[0].lower >= 1e-3);
}

}  // namespace fettle::design::problem::witness_branches_test
