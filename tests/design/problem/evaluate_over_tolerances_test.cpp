// SPDX-License-Identifier: MIT
// Robust designs: formulas with closed forms, a part's mass, and a box that falls on a table.
#include "design/problem/evaluate_over_tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/base/parallel.hpp"
#include "design/description/made_design.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/small_design.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::design::problem::evaluate_over_tolerances_test {

namespace {

constexpr double degree = std::numbers::pi / 180;

const char* const block = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.03,
    "variables": {"length": "10 mm", "unused": "2 mm"},
    "bodies": [{"name": "block", "density": 1000,
                "shape": {"part": "box", "dimensions": {"size_x": "= length", "size_y": 10, "size_z": 10}}}]})";

// One-way clutch (Gao, Chase and Magleby): the wedge's angle is acos((a + c)/(e - c)).
const char* const clutch = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "a", "value": 27.645, "lower": 26, "upper": 29}, {"name": "c", "value": 11.43, "lower": 11, "upper": 12},
                   {"name": "e", "value": 50.8, "lower": 45, "upper": 55}],
    "objective": [{"type": "expression", "expression": "a / 1 mm + 3 * c / 1 mm - e / 1 mm"}],
    "constraints": [{"type": "relation", "name": "angle", "expression": "acos((a + c) / (e - c))", "upper": "7.5 deg", "over_tolerances": OVER},
                    {"type": "relation", "name": "ring", "expression": "e", "lower": 50.8, "upper": 50.8, "over_tolerances": "as_drawn"},
                    {"type": "relation", "name": "roller", "expression": "c", "lower": 11.43, "upper": 11.43, "over_tolerances": "as_drawn"}],
    "tolerances": {"a": "+-0.05 mm", "c": "+-0.01", "e": {"lower": "-0.0125 mm", "upper": 0.0125, "shift": "0.002 mm"}}})json";

// Nominal 10 mm on a side, 1 g/cm^3; depth and the scene's variable `length` are made with tolerances, and one place.
const char* const block_design = R"json({"fettle_design": 1, "scene": "block.scene.json", "units": "mm",
    "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}, {"name": "height", "value": 10, "lower": 5, "upper": 20}],
    "set": {"/bodies/block/shape/dimensions/size_y": "= depth", "/bodies/block/shape/dimensions/size_z": "= height"},
    "objective": [{"type": "mass", "name": "mass", "bodies": ["block"], "over_tolerances": {"sigma": 2}},
                  {"type": "mass", "name": "other", "bodies": ["block"], "weight": -0.25, "over_tolerances": "worst_case"}],
    "constraints": [{"type": "mass", "name": "weight", "bodies": ["block"], "lower": "0.9 g", "upper": "1.3 g"},
                    {"type": "mass", "name": "drawn", "bodies": ["block"], "lower": "0.5 g", "over_tolerances": "as_drawn"}],
    "tolerances": {"depth": {"lower": -0.1, "upper": 0.3}, "length": "+-0.2 mm", "/bodies/block/density": {"lower": -20, "upper": 20}},
    "over_tolerances": {"sigma": 3}})json";

struct Folder : tests::support::TemporaryFolder {
    Folder() { write("block.scene.json", block); }
    Result<reading::DesignFile> read(std::string text, const std::string& over = R"({"sigma": 3})", bool as_made = false) {
        if (const std::size_t at = text.find("OVER"); at != std::string::npos) text.replace(at, 4, over);
        reading::DesignReadOptions options;
        options.as_made = as_made;
        return reading::parse_design(text, file("x.design.json"), options);
    }
};

DesignProblem problem_of(const Result<reading::DesignFile>& file) {
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    Result<DesignProblem> problem = DesignProblem::create(file->design);
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    return std::move(problem).value();
}

double clutch_angle(double a, double c, double e) { return std::acos((a + c) / (e - c)); }

// At 3 sigma, lengths in m; derivatives by central differences of the angle alone.
double robust_clutch_angle(double a, double c, double e) {
    constexpr double h = 1e-7;
    const double ga = (clutch_angle(a + h, c, e) - clutch_angle(a - h, c, e)) / (2 * h);
    const double gc = (clutch_angle(a, c + h, e) - clutch_angle(a, c - h, e)) / (2 * h);
    const double ge = (clutch_angle(a, c, e + h) - clutch_angle(a, c, e - h)) / (2 * h);
    return clutch_angle(a, c, e) + ge * 2e-6 + 3 * std::hypot(ga * 0.05e-3 / 3, gc * 0.01e-3 / 3, ge * 0.0125e-3 / 3);
}

// All rows against differences of values: objective, constraints, relations.
void check_gradients(const DesignProblem& problem, double share, double epsilon) {
    const VectorX p = description::values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    EvaluateOptions values;
    values.gradients = false;
    for (int k = 0; k < problem.parameter_count(); ++k) {
        const description::Parameter& parameter = problem.design().parameters[k];
        INFO("by " << parameter.name);
        const double h = share * (parameter.upper - parameter.lower);
        const DesignEvaluation above = problem.evaluate(p + h * VectorX::Unit(p.size(), k), values);
        const DesignEvaluation below = problem.evaluate(p - h * VectorX::Unit(p.size(), k), values);
        REQUIRE((above.usable && below.usable));
        CHECK(above.gradient.size() == 0);
        const auto check = [&](double gradient, double up, double down, double scale) {
            CHECK(gradient == Approx((up - down) / (2 * h)).epsilon(epsilon).margin(epsilon * scale));
        };
        check(at.gradient[k], above.objective, below.objective, at.gradient.cwiseAbs().maxCoeff());
        for (Eigen::Index i = 0; i < at.jacobian.rows(); ++i)
            check(at.jacobian(i, k), above.constraints[i].value, below.constraints[i].value, at.jacobian.row(i).cwiseAbs().maxCoeff());
        for (Eigen::Index i = 0; i < at.relations.values.size(); ++i)
            check(at.relations.jacobian(i, k), above.relations.values[i], below.relations.values[i],
                  at.relations.jacobian.row(i).cwiseAbs().maxCoeff());
    }
}

}  // namespace

TEST_CASE("a robust relation of the one-way clutch: its value at 3 sigma and in the worst case") {
    Folder folder;
    const DesignProblem robust = problem_of(folder.read(clutch));
    const VectorX p = description::values_of(robust.design().parameters);
    REQUIRE(p.size() == 3);
    const DesignEvaluation at = robust.evaluate(p);
    REQUIRE(at.usable);
    // The published sigma, and what the shift of e adds.
    CHECK(at.relations.values[0] / degree == Approx(7.018389803 + 11.821227 * 0.002 + 3 * 0.2192924).epsilon(1e-7));
    CHECK(at.relations.values[1] == Approx(50.8e-3));
    const DesignProblem worst = problem_of(folder.read(clutch, R"("worst_case")"));
    CHECK(worst.evaluate(p).relations.values[0] / degree == Approx(7.018389803 + 0.980606).epsilon(1e-6));
    check_gradients(robust, 1e-5, 1e-6);
    check_gradients(worst, 1e-5, 1e-6);
}

TEST_CASE("a robust optimum of the one-way clutch is where its closed form is") {
    Folder folder;
    const DesignProblem robust = problem_of(folder.read(clutch));
    const auto outcome = studies::optimise_design(robust);
    REQUIRE(outcome);
    INFO(outcome->report.message);
    CHECK(outcome->report.status == optimisers::OptimiserStatus::optimal);
    const double most = 7.5 * degree - robust.design().relations[0].bounds.margin;  // which the optimiser keeps away from
    double lower = 26e-3, upper = 29e-3;                                            // the angle falls with a
    for (int k = 0; k < 60; ++k) {
        const double middle = (lower + upper) / 2;
        (robust_clutch_angle(middle, 11.43e-3, 50.8e-3) > most ? lower : upper) = middle;
    }
    // To the optimiser's tolerance, 1e-4 of an objective of 11 mm; the reserve is worth 55 um.
    CHECK(outcome->report.point[0] == Approx(upper).epsilon(0).margin(1.2e-6));
}

TEST_CASE("a robust design's numbers: a variable and a place that no parameter moves, both sides of a bound, terms of the objective") {
    Folder folder;
    const auto file = folder.read(block_design);
    const DesignProblem problem = problem_of(file);
    const description::Design& design = problem.design();
    REQUIRE(design.parameters.size() == 2);  // the optimiser moves no tolerance
    REQUIRE(design.constraints.size() == 3);
    CHECK(design.constraints[0].name == "weight, at least");
    CHECK(design.constraints[1].name == "weight, at most");
    const VectorX p = description::values_of(design.parameters);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    // In g: 0.1 per mm of a side, 1e-3 per kg/m^3; depth's middle is 0.1 mm off, its sigma 0.2/3 mm.
    const double mean = 1 + 0.01, sigma = std::hypot(0.1 * 0.2 / 3, 0.1 * 0.2 / 3, 1e-3 * 20 / 3);
    CHECK(at.constraints[0].value * 1e3 == Approx(mean - 3 * sigma).epsilon(1e-9));
    CHECK(at.constraints[1].value * 1e3 == Approx(mean + 3 * sigma).epsilon(1e-9));
    CHECK(at.constraints[2].value * 1e3 == Approx(1).epsilon(1e-12));
    CHECK(at.terms[0].value * 1e3 == Approx(mean + 2 * sigma).epsilon(1e-9));
    CHECK(at.terms[1].value * 1e3 == Approx(1 - 0.1 * 0.1 - 0.1 * 0.2 - 0.02).epsilon(1e-9));
    CHECK(at.objective == Approx(at.terms[0].value * 1e3 - 0.25 * at.terms[1].value * 1e3).epsilon(1e-9));
    REQUIRE(at.robust.size() == 4);
    const RobustRow* row = robust_row(at, false, 1);
    REQUIRE(row != nullptr);
    CHECK(row->drawn.value * 1e3 == Approx(1));
    CHECK(row->standard_deviation * 1e3 == Approx(sigma));
    CHECK_FALSE(row->is_at_kink);
    CHECK(robust_row(at, false, 2) == nullptr);
    check_gradients(problem, 1e-4, 1e-6);
    // What is made has to meet the bounds without a reserve.
    const auto made = folder.read(block_design, "", true);
    REQUIRE(made);
    REQUIRE(made->design.constraints.size() == 2);
    CHECK_FALSE(made->design.constraints[0].bounds.over_tolerances);
}

TEST_CASE("a robust design without deviations is the design as drawn") {
    Folder folder;
    std::string text = block_design;
    const std::string tolerances =
        R"({"depth": {"lower": -0.1, "upper": 0.3}, "length": "+-0.2 mm", "/bodies/block/density": {"lower": -20, "upper": 20}})";
    text.replace(text.find(tolerances), tolerances.size(), R"({"depth": "+-0", "length": "+-0 mm"})");
    const DesignProblem robust = problem_of(folder.read(text));
    text.replace(text.find(R"({"sigma": 3})"), 12, R"("as_drawn")");
    for (const char* over : {R"({"sigma": 2})", R"("worst_case")"})
        text.replace(text.find(over), std::string(over).size(), R"("as_drawn")");
    const DesignProblem drawn = problem_of(folder.read(text));
    CHECK(drawn.design().as_made == nullptr);
    const VectorX p = description::values_of(robust.design().parameters);
    const DesignEvaluation one = robust.evaluate(p), other = drawn.evaluate(p);
    CHECK(one.objective == other.objective);
    CHECK(one.gradient == other.gradient);
    CHECK(one.constraints[0].value == other.constraints[0].value);
}

TEST_CASE("a robust design with contact: its gradients are those of its values") {
    tests::support::TemporaryFolder folder;
    folder.write("small.scene.json", tests::design_support::small_scene);
    const auto file = reading::parse_design(R"json({
        "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{ "name": "height", "value": 10, "lower": 6, "upper": 14 }, { "name": "place", "value": 3, "lower": -5, "upper": 20 }],
        "set": { "/bodies/cube/shape/dimensions/size_z": "= height", "/bodies/cube/position/0": "= place",
                 "/bodies/cube/position/2": "= height / 2 + 0.12" },
        "objective": [{ "type": "marker_path", "body": "cube", "point": [3, 2, 1], "points": [[4, 2, 7]], "times": [0.052], "over_tolerances": { "sigma": 3 } }],
        "constraints": [{ "type": "clearance", "a": "cube", "b": "wall", "minimum": 15, "motion": true },
                        { "type": "stroke", "body": "cube", "axis": [0, 0, 1], "upper": 30 }],
        "tolerances": { "height": "+-0.2 mm", "place": "+-0.2 mm", "/bodies/cube/density": "+-30", "/bodies/cube/shape/dimensions/size_x": "+-0.2 mm" },
        "over_tolerances": { "sigma": 3 } })json",
                                            folder.file("small.design.json"));
    const DesignProblem problem = problem_of(file);
    const VectorX p = description::values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    const RobustRow* row = robust_row(at, false, 0);
    REQUIRE(row != nullptr);
    CHECK(row->standard_deviation > 0.05e-3);
    CHECK(at.constraints[0].value == row->drawn.value - 3 * row->standard_deviation);
    CHECK_FALSE(at.constraints[0].is_proven);
    CHECK(at.constraints[0].clearance);
    check_gradients(problem, 1e-5, 1e-4);
    const core::base::ThreadLimit one(1);
    const DesignEvaluation again = problem.evaluate(p);
    CHECK(again.gradient == at.gradient);
    CHECK(again.jacobian == at.jacobian);
}

TEST_CASE("a robust design that has more numbers than tolerances takes its differences along these") {
    Folder folder;
    std::string text = block_design;
    const std::string tolerances =
        R"({"depth": {"lower": -0.1, "upper": 0.3}, "length": "+-0.2 mm", "/bodies/block/density": {"lower": -20, "upper": 20}})";
    text.replace(text.find(tolerances), tolerances.size(), R"({"depth": {"lower": -0.1, "upper": 0.3}})");
    int simulations = 0;
    const auto file = folder.read(text);
    const DesignProblem problem = problem_of(file);
    const Result<DesignProblem> made = DesignProblem::create(problem.design().as_made->design);
    REQUIRE(made);
    const auto counted = [&](const VectorX& p, const EvaluateOptions& options) {
        ++simulations;
        return made->evaluate(p, options);
    };
    const core::base::ThreadLimit one(1);
    const VectorX p = description::values_of(problem.design().parameters);
    REQUIRE(evaluate_over_tolerances(problem.design(), {counted}, p, {}).usable);
    CHECK(simulations == 3);
    check_gradients(problem, 1e-4, 1e-6);
}

TEST_CASE("a robust design beside which nothing can be made is not usable; one side is enough") {
    Folder folder;
    const DesignProblem problem = problem_of(folder.read(block_design));
    const Result<DesignProblem> made = DesignProblem::create(problem.design().as_made->design);
    REQUIRE(made);
    const VectorX p = description::values_of(problem.design().parameters);
    const VectorX here = problem.design().as_made->extended(p);
    const auto jammed = [&](const VectorX& at, const EvaluateOptions& options, bool above_too) {
        if (at != here && (above_too || at[0] < here[0])) {
            DesignEvaluation none;
            none.reason = "it jams";
            return none;
        }
        return made->evaluate(at, options);
    };
    const DesignEvaluation exact = problem.evaluate(p);
    const DesignEvaluation one_sided = evaluate_over_tolerances(
        problem.design(), {[&](const VectorX& at, const EvaluateOptions& options) { return jammed(at, options, false); }}, p, {});
    REQUIRE(one_sided.usable);
    CHECK((one_sided.gradient - exact.gradient).norm() < 1e-3 * exact.gradient.norm());
    const DesignEvaluation none = evaluate_over_tolerances(
        problem.design(), {[&](const VectorX& at, const EvaluateOptions& options) { return jammed(at, options, true); }}, p, {});
    CHECK_FALSE(none.usable);
    CHECK(none.reason.find("it jams") != std::string::npos);
}

TEST_CASE("robust designs: faults name the entry and say what is allowed") {
    Folder folder;
    const auto fault = [&](const std::string& over) {
        const auto file = folder.read(clutch, over);
        REQUIRE_FALSE(file);
        return file.errors().front().where + ": " + file.errors().front().message;
    };
    CHECK(fault("3").find("worst_case") != std::string::npos);
    CHECK(fault(R"("wrost_case")").find("worst_case") != std::string::npos);
    CHECK(fault(R"({"sigma": -1})").find("#/constraints/0/over_tolerances/sigma") != std::string::npos);
    CHECK(fault(R"({"sigmas": 3})").find("sigma") != std::string::npos);
    std::string text = clutch;
    text.replace(text.find(R"("over_tolerances": "as_drawn")"), 29, R"("over_tolerances": "worst_case")");
    const auto equation = folder.read(text);
    REQUIRE_FALSE(equation);
    CHECK(equation.errors().front().message.find("exactly") != std::string::npos);
    text = clutch;
    text.resize(text.find(",\n    \"tolerances\""));
    const auto without = folder.read(text + "}");
    REQUIRE_FALSE(without);
    CHECK(without.errors().front().message.find("no `tolerances`") != std::string::npos);
}

}  // namespace fettle::design::problem::evaluate_over_tolerances_test
