// SPDX-License-Identifier: MIT
// A clearance that is proven over the tolerances, as a requirement: two bars and a post, against the closed form, its derivative and the
// optimum.
#include "design/problem/proven_clearance.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/two_bars.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::problem::proven_clearance_test {

namespace {

std::string design(const std::string& constraint, const std::string& more = "") {
    return R"json({"fettle_design": 1, "scene": "x.scene.json", "units": "mm", "simulation": {"steps": 1},
        "parameters": [{"name": "fore_length", "value": 50, "lower": 30, "upper": 60}, {"name": "width", "value": 19, "lower": 10, "upper": 20}],
        "objective": [{"type": "mass", "bodies": ["fore"], "weight": -1}], "constraints": [)json" +
           constraint + R"json(],
        "tolerances": {"upper_length": "+-0.1 mm", "fore_length": {"lower": -0.3, "upper": 0.2}, "width": "+-0.1 mm", "post_at": "+-0.4 mm"})json" +
           more + "}";
}
const char* const proven = R"({"type": "clearance", "a": "fore", "b": "post", "minimum": 2, "ranges": true, "over_tolerances": "proven"})";

struct Folder : tests::support::TemporaryFolder {
    Folder() { write("x.scene.json", tests::design_support::two_bars); }
    Result<reading::DesignFile> read(const std::string& text) const { return reading::parse_design(text, file("x.design.json"), {}); }
    std::string fault(const std::string& text) const {
        const auto read_one = read(text);
        return read_one ? "" : read_one.errors().front().where + ": " + read_one.errors().front().message;
    }
};

// Nearest where the bars are stretched and a corner is on the axis, each length at its worst.
double least(double fore, double width) { return 114.6e-3 - 60.1e-3 - std::hypot(fore + 0.2e-3, (width + 0.1e-3) / 2); }

}  // namespace

TEST_CASE("A clearance proven over the tolerances, and its derivative, against the closed form", "[toleranced]") {
    const Folder folder;
    const auto file = folder.read(design(proven));
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    const auto problem = DesignProblem::create(file->design);
    REQUIRE(problem);
    for (const auto& [fore, width] : {std::pair{40e-3, 12e-3}, {52e-3, 19e-3}}) {
        const VectorX p = Vector2(fore, width);
        EvaluateOptions options;
        options.gradients = true;
        const DesignEvaluation e = problem->evaluate(p, options);
        INFO(fore << " " << width << " " << e.reason);
        REQUIRE(e.usable);
        const auto& measured = e.constraints[0];
        CHECK(measured.is_proven);
        CHECK(measured.lower <= least(fore, width) + 1e-12);
        CHECK(measured.upper - measured.lower <= 1e-7);
        CHECK(measured.value == Approx(least(fore, width)).epsilon(1e-9));
        const double way = std::hypot(fore + 0.2e-3, (width + 0.1e-3) / 2);
        CHECK(e.jacobian(0, 0) == Approx(-(fore + 0.2e-3) / way).epsilon(1e-8));
        CHECK(e.jacobian(0, 1) == Approx(-(width + 0.1e-3) / 4 / way).epsilon(1e-6));
        REQUIRE(e.robust.size() == 1);
        CHECK(e.robust[0].drawn.value == Approx(115e-3 - 60e-3 - std::hypot(fore, width / 2)).epsilon(1e-7));
        const auto& tolerances = problem->design().as_made->tolerances;
        for (int k = 0; k < count_of(tolerances); ++k) {
            const auto& limits = tolerances[k].deviation;
            CHECK(e.robust[0].deviations[k] == Approx(tolerances[k].of == "post_at" ? limits.lower : limits.upper));
        }
        // Without a simulation.
        const auto rows = problem->rest_rows(p);
        REQUIRE(rows);
        const auto rest = problem->rest_constraints();
        const auto row = std::find(rest.begin(), rest.end(), 0) - rest.begin();
        CHECK(rows->values[row] == measured.value);
        CHECK((rows->jacobian.row(row) - e.jacobian.row(0)).norm() <= 1e-12);
    }
}

TEST_CASE("The optimum under a clearance that is proven over the tolerances", "[toleranced][slow]") {
    const Folder folder;
    const auto file = folder.read(design(proven));
    REQUIRE(file);
    const auto problem = DesignProblem::create(file->design);
    REQUIRE(problem);
    studies::OptimiseOptions options;
    const auto outcome = studies::optimise_design(*problem, options);
    REQUIRE(outcome);
    INFO(outcome->final.reason);
    REQUIRE(outcome->final.usable);
    const VectorX& p = outcome->final.parameters;
    CHECK(p[1] == Approx(20e-3));
    CHECK(outcome->final.constraints[0].lower >= 2e-3);
    CHECK(least(p[0], p[1]) == Approx(2e-3).epsilon(2e-3));  // the margin
}

TEST_CASE("What cannot be proven over the tolerances is refused where it is asked", "[toleranced]") {
    const Folder folder;
    const auto with = [&](const std::string& over) { return design(proven, R"(, "over_tolerances": )" + over); };
    CHECK(folder.fault(with(R"({"sigma": 3})")).empty());
    CHECK_THAT(folder.fault(with("\"proven\"")), Catch::Contains("as_drawn") && Catch::Contains("worst_case"));
    const std::string over = R"(, "over_tolerances": "proven"})";
    CHECK_THAT(folder.fault(design(R"({"type": "clearance", "a": "fore", "b": "post", "minimum": 2, "motion": true)" + over)),
               Catch::Contains("as assembled or over the ranges of the joints"));
    CHECK_THAT(folder.fault(design(R"({"type": "mass", "bodies": ["fore"], "upper": "9 g")" + over)), Catch::Contains("worst_case"));
    CHECK_THAT(folder.fault(design(R"({"type": "relation", "name": "r", "expression": "width", "upper": 18)" + over)),
               Catch::Contains("worst_case"));
    // A part that cannot be made of some: the evaluation says so.
    std::string wide = design(proven);
    wide.replace(wide.find(R"("width": "+-0.1 mm")"), std::string(R"("width": "+-0.1 mm")").size(), R"("width": "+-13 mm")");
    const auto file = folder.read(wide);
    REQUIRE(file);
    const auto problem = DesignProblem::create(file->design);
    REQUIRE(problem);
    const DesignEvaluation e = problem->evaluate(Vector2(40e-3, 12e-3), {});
    CHECK_FALSE(e.usable);
    CHECK_THAT(e.reason, Catch::Contains("within the tolerances it cannot be made"));
}

}  // namespace fettle::design::problem::proven_clearance_test
