// SPDX-License-Identifier: MIT
// The slider-crank that stands its tolerances: strokes and optimum have closed forms, since the play is in the joints.
#include <catch2/catch.hpp>
#include <cmath>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_design.hpp"

namespace fettle::design::examples::robust_crank_test {

namespace {

problem::DesignProblem robust_crank() {
    auto file = reading::read_design("examples/slider_crank/robust.design.json");
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    auto problem = problem::DesignProblem::create(std::move(file->design));
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    return std::move(problem).value();
}

double value_of(const problem::DesignProblem& problem, const problem::DesignEvaluation& at, const std::string& name) {
    for (std::size_t i = 0; i < at.constraints.size(); ++i)
        if (problem.design().constraints[i].name == name) return at.constraints[i].value;
    FAIL("no constraint " << name);
    return 0;
}

// The crank counts twice, and so does each of the three pins and bores: +-0.1 mm at 3 sigma.
const double reserve = 0.1e-3 * std::sqrt(4 + 6 * 4);

}  // namespace

TEST_CASE("the robust slider-crank: its strokes are twice crank and play, and their reserve") {
    const problem::DesignProblem problem = robust_crank();
    problem::EvaluateOptions values;
    values.gradients = false;
    const auto at = problem.evaluate(description::values_of(problem.design().parameters), values);
    INFO(at.reason);
    REQUIRE(at.usable);
    const double twice_crank = 30e-3, twice_play = 2 * 3 * 0.25e-3;
    CHECK(value_of(problem, at, "longest stroke") == Approx(twice_crank + twice_play + reserve).epsilon(1e-6));
    CHECK(value_of(problem, at, "shortest stroke") == Approx(twice_crank - twice_play - reserve).epsilon(1e-6));
}

TEST_CASE("the robust slider-crank is tuned to its closed form, from the file's start and a random one", "[slow]") {
    const problem::DesignProblem problem = robust_crank();
    for (const std::uint64_t seed : {0, 1}) {
        studies::OptimiseOptions options;
        options.seed = seed;
        const auto outcome = studies::optimise_design(problem, options);
        REQUIRE(outcome);
        INFO("seed " << seed << ": " << outcome->report.message);
        CHECK(outcome->report.feasible);
        const VectorX& p = outcome->report.point;
        constexpr double margin = 2e-6;
        CHECK(p[3] == Approx(15e-3).epsilon(1e-5));
        CHECK(5.4e-3 - p[0] + 4.4e-3 - p[1] + 3.4e-3 - p[2] == Approx((2e-3 - margin - reserve) / 2).epsilon(1e-4));
        CHECK(p[5] == Approx(14e-3));
        CHECK(p[6] == Approx(9.2e-3));
    }
}

}  // namespace fettle::design::examples::robust_crank_test
