// SPDX-License-Identifier: MIT
#include "fettle/design/problem/design_problem.hpp"

#include <catch2/catch.hpp>

#include "fettle/design/problem/optimiser_problem.hpp"
#include "fettle/tests/design/small_problem.hpp"

namespace {

using namespace fettle;
using namespace fettle::design::problem;
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
