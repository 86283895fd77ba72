// SPDX-License-Identifier: MIT
// What is wanted and required as formulas: of named quantities, of parameters; bounds and targets that follow from parameters.
#include <catch2/catch.hpp>
#include <cmath>

#include "design/gradient_audit/difference_check.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::problem::expressions_test {

namespace {

using namespace fettle::tests::design_support;
using description::Constraint;
using description::values_of;

// The small design with other objective and constraints, and quantities by name.
std::string design_with(const std::string& objective, const std::string& constraints) {
    const std::string text = small_design;
    return text.substr(0, text.find("\"objective\"")) + R"("quantities": {
    "rise": { "type": "stroke", "body": "cube", "axis": [0, 0, 1] },
    "drift": { "type": "stroke", "body": "cube", "axis": [1, 0, 0] },
    "cube mass": { "type": "mass", "bodies": ["cube"] },
    "gap": { "type": "clearance", "a": "cube", "b": "wall", "motion": true }
  },
  "objective": [)" +
           objective + "],\n  \"constraints\": [" + constraints + "] }";
}

DesignEvaluation evaluated(const std::string& design) {
    const DesignFolder folder(design);
    const DesignProblem problem = problem_of(folder);
    const DesignEvaluation at = problem.evaluate(values_of(problem.design().parameters));
    INFO(at.reason);
    REQUIRE(at.usable);
    return at;
}

Errors errors_of(const std::string& design) {
    const DesignFolder folder(design);
    return reading::read_design(folder.design()).errors();
}

std::string reason_of(const std::string& design, const VectorX& change) {
    const DesignFolder folder(design);
    const DesignProblem problem = problem_of(folder);
    const DesignEvaluation at = problem.evaluate(values_of(problem.design().parameters) + change);
    CHECK_FALSE(at.usable);
    CHECK(std::isnan(at.objective));
    return at.reason;
}

const std::string plain_rows = R"(
    { "type": "stroke", "body": "cube", "axis": [0, 0, 1], "lower": 0 },
    { "type": "stroke", "body": "cube", "axis": [1, 0, 0], "lower": 0 },
    { "type": "mass", "bodies": ["cube"], "lower": 0 },
    { "type": "clearance", "a": "cube", "b": "wall", "motion": true, "minimum": 1 })";

double largest(const MatrixX& m) { return m.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("an expression of quantities and parameters is differentiated by the chain rule") {
    const std::string ratio = R"x({ "type": "expression", "name": "ratio", "expression": "rise * drift / height + 0.1 * drift" })x";
    const DesignEvaluation at = evaluated(design_with(ratio, plain_rows + "," + ratio.substr(0, ratio.size() - 2) + R"(, "upper": 5 },
        { "type": "expression", "expression": "= sqrt('cube mass' / 2 g) - gap / width", "upper": 5 },
        { "type": "expression", "expression": "= gap / width", "upper": 5 })"));
    const double rise = at.constraints[0].value, drift = at.constraints[1].value, mass = at.constraints[2].value,
                 gap = at.constraints[3].value, height = 0.01, width = 0.02;
    CHECK(at.constraints[4].value == Approx(rise * drift / height + 0.1 * drift).epsilon(1e-14));
    CHECK(at.objective == Approx(at.constraints[4].value / 1e-3).epsilon(1e-14));
    MatrixX expected = at.jacobian.row(0) * drift / height + at.jacobian.row(1) * (rise / height + 0.1);
    expected(0, 0) -= rise * drift / (height * height);
    CHECK(largest(at.jacobian.row(4) - expected) < 1e-12 * largest(expected));
    CHECK(largest(at.gradient.transpose() * 1e-3 - expected) < 1e-12 * largest(expected));
    CHECK(at.constraints[5].value == Approx(std::sqrt(mass / 2e-3) - gap / width).epsilon(1e-14));
    expected = at.jacobian.row(2) / (2 * std::sqrt(mass * 2e-3)) - at.jacobian.row(3) / width;
    expected(0, 1) += gap / (width * width);
    CHECK(largest(at.jacobian.row(5) - expected) < 1e-12 * largest(expected));
    // The proven bounds of the clearance make those of the expression: no more, and not much less.
    const auto &certified = at.constraints[3], &whole = at.constraints[5];
    CHECK(whole.lower <= std::sqrt(mass / 2e-3) - certified.upper / width);
    CHECK(whole.upper >= std::sqrt(mass / 2e-3) - certified.lower / width);
    CHECK(whole.upper - whole.lower < 1.01 * (certified.upper - certified.lower) / width + 1e-13);
    CHECK(at.constraints[4].lower == at.constraints[4].upper);
    // Proven are certified distances and formulas of these alone: no stroke, no mass.
    std::vector<bool> proven;
    for (const auto& measured : at.constraints) proven.push_back(measured.is_proven);
    CHECK(proven == std::vector<bool>{false, false, false, true, false, false, true});
}

TEST_CASE("a bound that follows from parameters enters its constraint with its derivative") {
    const DesignFolder folder(design_with(R"({ "type": "mass", "bodies": ["cube"] })", plain_rows + R"x(,
        { "type": "stroke", "body": "cube", "axis": [0, 0, 1], "lower": "= height / 20", "upper": 30 },
        { "type": "stroke", "name": "as far as it is high", "body": "cube", "axis": [1, 0, 0], "upper": "= 2 * height + 1" },
        { "type": "mass", "bodies": ["cube"], "lower": "= 2 g * width / 20 mm", "upper": "= 2 g * width / 20 mm" },
        { "type": "clearance", "a": "cube", "b": "wall", "motion": true, "minimum": "= width / 2", "windows": 2 },
        { "type": "expression", "expression": "rise - drift", "upper": "= place" })x"));
    const DesignProblem problem = problem_of(folder);
    const DesignEvaluation at = problem.evaluate(values_of(problem.design().parameters));
    REQUIRE(at.usable);
    const std::vector<Constraint>& constraints = problem.design().constraints;
    REQUIRE(constraints.size() == 11);
    const auto row_of = [&](int i, int of, int parameter, double slope) {
        MatrixX expected = at.jacobian.row(of);
        expected(0, parameter) -= slope;
        CHECK(largest(at.jacobian.row(i) - expected) < 1e-14);
    };
    const auto value = [&](int i) { return at.constraints[i].value; };
    CHECK(constraints[4].name == "stroke cube - (height / 20)");
    CHECK(value(4) == Approx(value(0) - 0.01 / 20).epsilon(1e-14));
    CHECK(constraints[4].bounds.lower == 0);
    CHECK(std::isinf(constraints[4].bounds.upper));
    row_of(4, 0, 0, 1.0 / 20);
    CHECK(constraints[5].bounds.upper == 0.03);  // the other side is about the stroke itself
    CHECK(value(5) == value(0));
    CHECK(constraints[6].name == "as far as it is high");
    CHECK(value(6) == Approx(value(1) - 0.021).epsilon(1e-14));
    row_of(6, 1, 0, 2);
    CHECK(constraints[7].bounds.lower == constraints[7].bounds.upper);
    CHECK(value(7) == Approx(value(2) - 2e-3).margin(1e-17));
    row_of(7, 2, 1, 0.1);
    CHECK(constraints[8].name == "clearance cube:wall over the motion - (width / 2) window 1");
    CHECK(std::min(value(8), value(9)) == Approx(value(3) - 0.01).epsilon(1e-9));
    CHECK(at.constraints[8].lower < value(8));
    CHECK(at.constraints[8].upper >= value(8));
    CHECK(value(10) == Approx(value(0) - value(1) - 0.003).epsilon(1e-14));
    CHECK(at.violation > 0);
}

TEST_CASE("targets that follow from parameters: value, gradient and curvature") {
    const auto at_target = [&](const std::string& target) {
        return evaluated(design_with(R"({ "type": "stroke", "body": "cube", "axis": [0, 0, 1], "target": )" + target + " }", plain_rows));
    };
    const DesignEvaluation moved = at_target("\"= height / 8\""), fixed = at_target("1.25");
    CHECK(moved.objective == Approx(fixed.objective).epsilon(1e-12));
    const double deviation = moved.constraints[0].value - 0.01 / 8;
    VectorX expected = fixed.gradient;
    expected[0] -= 2 * deviation / 8 / 1e-6;
    CHECK(largest(moved.gradient - expected) < 1e-12 * largest(expected));
    CHECK((moved.residual_jacobian.row(0) - fixed.residual_jacobian.row(0))[0] == Approx(-1e3 / 8));

    const auto along = [&](const std::string& points, const std::string& times) {
        return evaluated(
            design_with(R"({ "type": "marker_path", "body": "cube", "point": [3, 2, 1], "points": )" + points + times + " }", plain_rows));
    };
    for (const std::string times : {R"(, "times": [0.052, 0.1])", ""}) {
        const DesignEvaluation path = along(R"([["= place + 1", 2, "= height * 0.7"], [8, "= width / 10 + 1", 6]])", times);
        const std::vector<std::string> plain{"4", "2", "7", "8", "3", "6"};
        const auto with = [&](int k, double change) {
            std::vector<std::string> numbers = plain;
            if (k >= 0) numbers[k] = std::to_string(std::stod(numbers[k]) + change);
            return along(
                "[[" + numbers[0] + "," + numbers[1] + "," + numbers[2] + "],[" + numbers[3] + "," + numbers[4] + "," + numbers[5] + "]]",
                times);
        };
        VectorX gradient = with(-1, 0).gradient;
        const auto slope = [&](int k) { return (with(k, 0.001).objective - with(k, -0.001).objective) / 0.002 * 1e3; };
        gradient[2] += slope(0);
        gradient[0] += 0.7 * slope(2);
        gradient[1] += 0.1 * slope(4);
        CHECK(path.objective == Approx(with(-1, 0).objective).epsilon(1e-12));
        CHECK(largest(path.gradient - gradient) < 1e-6 * largest(gradient));
        const VectorX by_deviations = 2 * path.residual_jacobian.transpose() * path.residuals;
        CHECK(largest(by_deviations - path.gradient) < 1e-9 * largest(path.gradient));
    }
}

TEST_CASE("gradient --check audits expressions under their names") {
    const DesignFolder folder(
        design_with(R"({ "type": "expression", "expression": "rise * height / width + drift" })",
                    R"({ "type": "expression", "name": "lively", "expression": "rise / drift", "lower": "= place / 1 m" })"));
    const DesignProblem problem = problem_of(folder);
    const VectorX p = values_of(problem.design().parameters);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    const auto report = gradient_audit::check_gradients(problem, p, at);
    CHECK(report.failures.empty());
    int named = 0;
    for (const auto& row : report.rows) {
        named += row.quantity == "lively";
        CAPTURE(row.quantity, row.parameter, row.adjoint, row.difference);
        CHECK((row.relative_error < 1e-4 || !row.resolved));
    }
    CHECK(named == 5);
    CHECK(report.sweeps.failure.empty());
    CHECK(report.sweeps.disagreement < 1e-6);
}

TEST_CASE("a slack parameter: what nothing of the scene follows from may bound and be minimised") {
    std::string text = design_with(R"({ "type": "expression", "expression": "peak" })",
                                   R"({ "type": "stroke", "body": "cube", "axis": [0, 0, 1], "upper": "= peak" },
                                      { "type": "stroke", "body": "cube", "axis": [1, 0, 0], "upper": "= peak" })");
    text = replaced(text, "\"parameters\": [", R"("parameters": [ { "name": "peak", "value": 2, "lower": 0, "upper": 9 },)");
    const DesignEvaluation at = evaluated(text);
    CHECK(at.objective == Approx(2));
    CHECK(largest(at.gradient.transpose() - VectorX::Unit(6, 0).transpose() * 1e3) < 1e-9);
    CHECK(at.jacobian(0, 0) == -1);
    CHECK(at.jacobian(1, 0) == -1);
    const Errors unused = errors_of(replaced(text, "\"expression\": \"peak\"", "\"expression\": \"rise\""));
    CHECK(unused.empty());  // the bounds name it still
}

TEST_CASE("faults of expressions are told with their place and a remedy") {
    const auto told = [&](const std::string& objective, const std::string& constraints, const std::string& place,
                          const std::string& words) {
        const Errors errors = errors_of(design_with(objective, constraints));
        CAPTURE(objective, constraints, place, words);
        REQUIRE_FALSE(errors.empty());
        CAPTURE(errors[0].where, errors[0].message);
        CHECK(errors[0].where.find(place) != std::string::npos);
        CHECK(errors[0].message.find(words) != std::string::npos);
    };
    const std::string fine = R"({ "type": "mass", "bodies": ["cube"] })";
    const auto of = [](const std::string& text) { return R"({ "type": "expression", "expression": ")" + text + "\" }"; };
    told(of("rise + 'cube mass'"), "", "#/objective/0/expression", "a mass");
    told(of("rise * 'cube mass'"), "", "#/objective/0/expression", "divide");
    told(of("rose / height"), "", "#/objective/0/expression", "rise");
    told(of("2 + 3"), "", "#/objective/0/expression", "no quantity");
    told(of("rise / "), "", "#/objective/0/expression", "");
    told(fine, R"({ "type": "expression", "expression": "height / width", "upper": 1 })", "#/constraints/0/expression", "relation");
    told(fine, R"({ "type": "expression", "expression": "rise / height" })", "#/constraints/0", "`lower`, `upper` or both");
    told(fine, R"({ "type": "expression", "expression": "rise / height", "upper": "3 mm" })", "#/constraints/0/upper", "number");
    told(fine, R"({ "type": "stroke", "body": "cube", "axis": [0, 0, 1], "upper": "= 2 * density" })", "#/constraints/0/upper", "density");
    told(fine, R"({ "type": "stroke", "body": "cube", "axis": [0, 0, 1], "lower": "= height", "upper": "= height / 2" })",
         "#/constraints/0/lower", "above the upper bound");
    told(fine, R"({ "type": "clearance", "a": "cube", "b": "wall", "minimum": "= place - 1 cm" })", "#/constraints/0/minimum",
         "greater than 0");
    told(fine, R"({ "type": "relation", "expression": "height", "upper": "= 2 * width" })", "#/constraints/0/upper", "subtract it");
    const auto named = [&](const std::string& quantity) {
        return errors_of(replaced(design_with(fine, ""), "\"quantities\": {", "\"quantities\": { " + quantity + ","));
    };
    Errors errors = named(R"("height": { "type": "mass", "bodies": ["cube"] })");
    REQUIRE_FALSE(errors.empty());
    CHECK(errors[0].where.find("#/quantities/height") != std::string::npos);
    CHECK(named(R"("other": { "type": "expression", "expression": "rise / height" })").empty());
    errors = named(R"("other": { "type": "expression", "expression": "rise * other / 1 mm" })");
    REQUIRE_FALSE(errors.empty());
    CHECK(errors[0].where.find("#/quantities/other") != std::string::npos);
    CHECK(errors[0].message.find("`other` follows from `other`: a quantity cannot follow from itself") != std::string::npos);
}

TEST_CASE("an expression that is no number, or has no derivative, is a failed evaluation that says why") {
    const auto with = [](const std::string& text) { return design_with(R"({ "type": "expression", "expression": ")" + text + "\" }", ""); };
    VectorX change = VectorX::Zero(5);
    const std::string by_zero = reason_of(with("rise / (drift - drift)"), change);
    CHECK(by_zero.find("objective `rise / (drift - drift)`: its value is not a finite number (") != std::string::npos);
    CHECK(by_zero.find("drift = ") != std::string::npos);
    CHECK(reason_of(with("log(-rise / 1 m)"), change).find("its value is not a finite number") != std::string::npos);
    const std::string root = reason_of(with("sqrt(height * (rise - rise))"), change);
    CHECK(root.find("derivative") != std::string::npos);
    CHECK(root.find("sqrt(height * (rise - rise))") != std::string::npos);
}

}  // namespace fettle::design::problem::expressions_test
