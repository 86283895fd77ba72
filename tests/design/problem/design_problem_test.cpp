// SPDX-License-Identifier: MIT
#include "design/problem/design_problem.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/stepper/simulate.hpp"
#include "design/problem/optimiser_problem.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::problem::design_problem_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::design::description::values_of;

}  // namespace

TEST_CASE("a trial that cannot be built or simulated says why") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    p[2] = 0.035;  // inside the wall
    const DesignEvaluation inside = problem.evaluate(p);
    CHECK_FALSE(inside.usable);
    CHECK(inside.reason.find("wall") != std::string::npos);
    p[2] = 0.003;
    EvaluateOptions stop;
    stop.should_stop = [] { return true; };
    const DesignEvaluation stopped = problem.evaluate(p, stop);
    CHECK(stopped.interrupted);
    CHECK_THROWS_AS(optimiser_evaluation(stopped), fettle::design::optimisers::Interrupted);
}

TEST_CASE("what keeps a design from being made is known without a simulation, in the same words") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    CHECK(problem.refusal(p).empty());
    p[2] = 0.035;  // inside the wall
    CHECK(problem.refusal(p).find("intersect") != std::string::npos);
    CHECK(problem.refusal(p) == problem.evaluate(p).reason);
    p[0] = -0.001;  // no box
    CHECK(problem.refusal(p).find("size_z") != std::string::npos);
    CHECK(problem.refusal(p) == problem.evaluate(p).reason);
    const auto seen = optimiser_problem(problem);
    CHECK(seen.refusal(p) == problem.refusal(p));
    CHECK(seen.relation_lower.size() == 0);
}

TEST_CASE("relations are requirements, seen by optimisers with their gradients, and no trial where they are no number is simulated") {
    const DesignFolder folder(replaced(small_design, "\"constraints\": [",
                                       R"x("constraints": [
        { "type": "relation", "expression": "height / width", "upper": 0.4 },
        { "type": "relation", "expression": "sqrt(width / height - 1)", "lower": 0, "margin": 0 },)x"));
    const DesignProblem problem = problem_of(folder);
    VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    CHECK(at.relations.values[0] == 0.5);
    CHECK(at.violation == Approx(0.1));
    CHECK(at.constraints.size() == 5);
    const auto seen = optimiser_problem(problem);
    CHECK(seen.relation_upper[0] < 0.4);
    CHECK(seen.relation_upper[0] > 0.3999);
    CHECK(seen.relation_lower[1] == 0);
    const auto relations = seen.relations(p);
    CHECK(relations.values == at.relations.values);
    CHECK(relations.jacobian.row(0).transpose() == problem.design().relations[0].at(p).gradient);
    CHECK(relations.jacobian.row(1)[1] == Approx(0.5 / 0.01));
    p[1] = 0.0249;
    CHECK(problem.evaluate(p).violation == Approx(0.01 / 0.0249 - 0.4));
    p[1] = 0.009;
    const DesignEvaluation undefined = problem.evaluate(p);
    CHECK_FALSE(undefined.usable);
    CHECK(undefined.runs.empty());
    CHECK(undefined.reason.find("relation `sqrt(width / height - 1)`") != std::string::npos);
    CHECK(problem.refusal(p) == undefined.reason);
}

TEST_CASE("an evaluation has the same bits each time, gradients asked for or not") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    EvaluateOptions without;
    without.gradients = false;
    const DesignEvaluation a = problem.evaluate(p), b = problem.evaluate(p, without);
    REQUIRE(a.usable);
    REQUIRE(b.usable);
    CHECK(a.objective == b.objective);
    for (size_t i = 0; i < a.constraints.size(); ++i) CHECK(a.constraints[i].value == b.constraints[i].value);
    // the whole motion's least distance is that of the nearer window
    CHECK(a.constraints[0].value == Approx(std::min(a.constraints[1].value, a.constraints[2].value)).margin(2e-9));
}

TEST_CASE("a design is simulated as it is evaluated, whoever asks for the simulation") {
    const DesignFolder folder;
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation evaluated = problem.evaluate(p);
    REQUIRE(evaluated.usable);
    const auto model = problem.model_at(p);
    REQUIRE(model);
    core::stepper::SimulationOptions options;
    options.steps = problem.design().steps;
    const core::stepper::Simulation shown = core::stepper::simulate(*model, options);
    const auto& poses = evaluated.runs.front().simulation.trajectory.poses;
    REQUIRE(shown.trajectory.poses.size() == poses.size());
    for (size_t t = 0; t < poses.size(); ++t)
        for (size_t i = 0; i < poses[t].size(); ++i) {
            CHECK(shown.trajectory.poses[t][i].position == poses[t][i].position);
            CHECK(shown.trajectory.poses[t][i].rotation == poses[t][i].rotation);
        }
}

}  // namespace fettle::design::problem::design_problem_test
