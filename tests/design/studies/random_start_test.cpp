// SPDX-License-Identifier: MIT
#include "design/studies/random_start.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "design/studies/optimise_design.hpp"
#include "tests/design/gradient_audit/density_design.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::studies::random_start_test {

namespace {

description::Design two_parameters() {
    description::Design design;
    for (const double width : {1.0, 1e-3}) {
        description::Parameter p;
        p.value = 0.25 * width;
        p.lower = -0.5 * width;
        p.upper = 1.5 * width;
        design.parameters.push_back(p);
    }
    return design;
}

}  // namespace

TEST_CASE("a start is a function of its seed; seed 0 is the design's own") {
    const description::Design design = two_parameters();
    CHECK(sample_of_seed(design, 0) == description::values_of(design.parameters));
    CHECK(sample_of_seed(design, 7001) == sample_of_seed(design, 7001));
    CHECK(sample_of_seed(design, 7001) != sample_of_seed(design, 7002));
    // The generator's published first outputs of seed 1234567: a start is the same on any machine.
    const VectorX known = sample_of_seed(design, 1234567);
    CHECK(known[0] == -0.5 + 2 * (static_cast<double>(6457827717110365317ULL >> 11) * 0x1p-53));
    CHECK(known[1] == -0.5e-3 + (static_cast<double>(3203168211198807973ULL >> 11) * 0x1p-53) * 2e-3);
}

TEST_CASE("starts fill the bounds evenly, each parameter for itself") {
    const description::Design design = two_parameters();
    const int n = 4000, cells = 4;
    int counts[cells][cells] = {};
    for (int seed = 1; seed <= n; ++seed) {
        const VectorX start = sample_of_seed(design, static_cast<std::uint64_t>(seed));
        const auto cell = [&](int k) {
            const description::Parameter& p = design.parameters[k];
            REQUIRE((start[k] >= p.lower && start[k] <= p.upper));
            return std::min(cells - 1, static_cast<int>(cells * (start[k] - p.lower) / (p.upper - p.lower)));
        };
        ++counts[cell(0)][cell(1)];
    }
    // 250 expected in each of 16 cells: within five standard deviations.
    for (const auto& row : counts) {
        for (const int count : row) CHECK(std::abs(count - n / 16) < 5 * std::sqrt(n / 16.0));
    }
}

TEST_CASE("a random start meets the relations and can be made and assembled, the same each time") {
    using fettle::tests::design_support::replaced;
    // The cube may be drawn into the wall; it is to be half as high as wide, and no farther out than it is wide.
    std::string text = replaced(fettle::tests::design_support::small_design, "\"upper\": 20 },", "\"upper\": 60 },");
    text = replaced(text, "\"constraints\": [", R"("constraints": [
        { "type": "relation", "expression": "height - width / 2", "lower": 0, "upper": 0 },
        { "type": "relation", "expression": "place - width", "upper": 0 },)");
    const fettle::tests::design_support::DesignFolder folder(text);
    const problem::DesignProblem problem = fettle::tests::design_support::problem_of(folder);
    int changed = 0, obstructed = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const VectorX start = start_of_seed(problem, seed), sample = sample_of_seed(problem.design(), seed);
        CHECK(problem.obstacles(start).empty());
        for (const description::Relation& relation : problem.design().relations)
            CHECK(description::violation(relation, relation.at(start).value) <= 0);
        CHECK(start == start_of_seed(problem, seed));
        changed += start == sample ? 0 : 1;
        obstructed += problem.obstacles(sample).empty() ? 0 : 1;
    }
    CHECK(changed == 60);
    CHECK(obstructed > 5);
}

TEST_CASE("later starts of a seed are other ones, every other near the values as written") {
    const fettle::tests::design_support::DesignFolder folder;
    const problem::DesignProblem problem = fettle::tests::design_support::problem_of(folder);
    const std::vector<description::Parameter>& parameters = problem.design().parameters;
    std::set<double> seen{start_of_seed(problem, 1001)[0]};
    for (int k = 1; k <= 12; ++k) {
        const VectorX start = later_start_of_seed(problem, 1001, k);
        CHECK(start == later_start_of_seed(problem, 1001, k));
        CHECK(seen.insert(start[0]).second);
        for (size_t i = 0; k % 2 == 1 && i < parameters.size(); ++i)
            CHECK(std::abs(start[static_cast<Eigen::Index>(i)] - parameters[i].value) <=
                  0.25 * (parameters[i].upper - parameters[i].lower));
    }
}

TEST_CASE("a random start from which nothing leads to what is required is followed by another") {
    using fettle::tests::design_support::OfDensities;
    // The requirement is met above 0.3, and says nothing of where that is below 0.2; below -0.1 it cannot even be measured.
    const auto required = [](const VectorX& u) { return u[0] < -0.1 ? std::nan("") : u[0] < 0.2 ? -1 : u[0] - 0.3; };
    const auto slope = [](const VectorX& u) { return VectorX(VectorX::Constant(1, u[0] < 0.2 ? 0 : 1)); };
    const auto beyond = [](const VectorX& u) { return std::max(0.0, u[0] - 0.3); };
    const auto objective = std::make_shared<OfDensities>([=](const VectorX& u) { return 2 + beyond(u) * beyond(u); },
                                                         [=](const VectorX& u) { return VectorX(VectorX::Constant(1, 2 * beyond(u))); });
    description::Design design =
        fettle::tests::design_support::density_problem(1, {objective, std::make_shared<OfDensities>(required, slope)}).design();
    design.constraints[0].bounds.lower = 0;
    const auto problem = problem::DesignProblem::create(std::move(design));
    REQUIRE(problem);
    int flat = 0, unmeasured = 0;
    for (const std::uint64_t seed : seeds_of_list(1, 20)) {
        const double u = (start_of_seed(*problem, seed)[0] - 1000) / 1000;
        const Result<OptimiseOutcome> found = optimise_design(*problem, {.seed = seed});
        REQUIRE(found);
        INFO("seed " << seed << " begins at " << u << ": " << found->report.message);
        if (seed == 0) {
            CHECK_FALSE(found->report.feasible);  // the design's own start is the user's
            continue;
        }
        flat += u < 0.2 && u >= -0.1;
        unmeasured += u < -0.1;
        CHECK(found->report.feasible);
        CHECK(found->report.point[0] == Approx(1300).epsilon(0.01));
        CHECK(found->report.evaluations <= problem->design().optimiser.max_evaluations);
        const Result<OptimiseOutcome> again = optimise_design(*problem, {.seed = seed});
        CHECK(again->report.point == found->report.point);
    }
    CHECK(flat > 3);
    CHECK(unmeasured > 1);
}

TEST_CASE("lists of seeds begin with the design's own start and share nothing else") {
    CHECK(seeds_of_list(7, 3) == std::vector<std::uint64_t>{0, 7001, 7002});
    CHECK(seeds_of_list(7, 1) == std::vector<std::uint64_t>{0});
    std::set<std::uint64_t> all;
    for (const std::uint64_t list : {0, 1, 2}) {
        for (const std::uint64_t seed : seeds_of_list(list, 1000)) all.insert(seed);
    }
    CHECK(all.size() == 3 * 999 + 1);
}

}  // namespace fettle::design::studies::random_start_test
