// SPDX-License-Identifier: MIT
#include "design/problem/smoother_models.hpp"

#include <catch2/catch.hpp>

#include "design/problem/optimiser_problem.hpp"
#include "design/reading/design_reader.hpp"

namespace fettle::design::problem::smoother_models_test {

namespace {

DesignProblem slider_crank() {
    auto file = reading::read_design("examples/slider_crank/slider_crank.design.json", {});
    REQUIRE(file);
    auto made = DesignProblem::create(std::move(file->design));
    REQUIRE(made);
    return std::move(made).value();
}

}  // namespace

TEST_CASE("constraints of the parts as assembled are known without a simulation, with their derivatives") {
    const DesignProblem problem = slider_crank();
    const optimisers::Problem seen = optimiser_problem(problem);
    CHECK(problem.rest_constraints() == std::vector<int>{0, 1, 2, 3});
    const auto rows = problem.rest_rows(seen.start);
    REQUIRE(rows);
    REQUIRE(rows->values.size() == 4);
    for (int k = 0; k < 7; ++k) {
        const double h = 1e-6;
        const auto above = problem.rest_rows(seen.start + h * VectorX::Unit(7, k));
        const auto below = problem.rest_rows(seen.start - h * VectorX::Unit(7, k));
        REQUIRE((above && below));
        CHECK(((above->values - below->values) / (2 * h) - rows->jacobian.col(k)).cwiseAbs().maxCoeff() < 1e-6);
    }
}

TEST_CASE("a start is moved onto the required play, and contact begins nearly as wide") {
    const DesignProblem problem = slider_crank();
    const optimisers::Problem seen = optimiser_problem(problem);
    REQUIRE(seen.prepared);
    const VectorX moved = seen.prepared(seen.start);
    const auto rows = problem.rest_rows(moved);
    REQUIRE(rows);
    for (int i = 0; i < 4; ++i) CHECK(rows->values[i] > 0.302e-3 - 1e-9);
    CHECK((moved.segment(3, 3) - seen.start.segment(3, 3)).norm() < 1e-12);  // what no play depends on stays

    CHECK(play_of_fits(problem, moved) == Approx(0.302e-3).epsilon(1e-3));
    const auto models = smoother_models(problem, moved);
    REQUIRE(models.size() == 2);
    CHECK(models[0].dhat == Approx(widest_share * 0.302e-3).epsilon(1e-3));
    CHECK(models[1].dhat == 0.5 * models[0].dhat);
    for (const SmootherDesign& model : models) {
        CHECK(model.problem.design().scene.dhat == model.dhat);
        CHECK(model.problem.design().parameters.size() == 7);
    }
    // Contact as wide as the play has nothing smoother before it.
    const auto wide = problem.with_contact_width(0.28e-3);
    REQUIRE(wide);
    CHECK(smoother_models(*wide, moved).empty());
}

}  // namespace fettle::design::problem::smoother_models_test
