// SPDX-License-Identifier: MIT
// Which extremes are hardly meant: of series that are given.
#include "design/problem/doubtful_extremes.hpp"

#include <catch2/catch.hpp>

#include "design/quantities/expression.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/quantities/step_series.hpp"
#include "design/quantities/worst.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::design::problem::doubtful_extremes_test {

namespace {

using description::Design;
using description::Quantity;
using quantities::Over;
using Shared = std::shared_ptr<const Quantity>;

// A torque of these numbers.
class Torque : public quantities::StepSeries {
public:
    Torque(std::vector<double> numbers, Over over, bool has_direction = true)
        : StepSeries(over), numbers_(std::move(numbers)), has_direction_(has_direction) {}
    Dimension instant_dimension() const override { return Dimension::torque; }
    bool has_direction() const override { return has_direction_; }

protected:
    std::vector<double> series(const description::Simulated&) const override { return numbers_; }
    void add_series_seeds(const description::Simulated&, const std::vector<double>&, description::Seeds&) const override {}

private:
    std::vector<double> numbers_;
    bool has_direction_;
};

Shared torque(std::vector<double> numbers, Over over, bool has_direction = true) {
    return std::make_shared<Torque>(std::move(numbers), over, has_direction);
}

Design design_of(const std::vector<Shared>& terms, const std::vector<std::pair<Shared, description::Bounds>>& constraints = {}) {
    Design design;
    core::scene::Body body;
    body.name = "body";
    body.mesh = tests::support::box_mesh(Vector3::Constant(-0.01), Vector3::Constant(0.01));
    design.scene.bodies = {body};
    design.steps = 3;
    for (const Shared& term : terms) design.objective.push_back({"t" + std::to_string(design.objective.size()), 1, 1e-3, term});
    for (const auto& [quantity, bounds] : constraints)
        design.constraints.push_back({"c" + std::to_string(design.constraints.size()), bounds, quantity});
    return design;
}

std::vector<std::string> told(const Design& design) {
    const auto problem = DesignProblem::create(design);
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    EvaluateOptions values;
    values.gradients = false;
    const DesignEvaluation at = problem->evaluate(VectorX(0), values);
    REQUIRE(at.usable);
    return doubtful_extremes(problem->design(), at);
}

const std::vector<double> turns_back{0.5e-3, -2e-3, 1e-3}, backwards{-1e-3, -2e-3, -3e-3}, forwards{1e-3, 2e-3, 3e-3};

}  // namespace

TEST_CASE("the largest of what turns round, or goes backwards alone, is told with its numbers") {
    const auto found =
        told(design_of({torque(turns_back, Over::largest), torque(backwards, Over::largest), torque(forwards, Over::largest)}));
    REQUIRE(found.size() == 2);
    CHECK(
        found[0] ==
        "objective `t0`: the largest of the steps is 1 N mm, but step 2 has -2 N mm, a larger absolute value: \"over\": \"peak\" takes the "
        "largest absolute value");
    CHECK(
        found[1].starts_with("objective `t1`: all steps are negative, and the largest, -1 N mm, is the one with the least absolute value"));
    CHECK(told(design_of({torque({-1e-3, -1e-3, -1e-3}, Over::largest)})).size() == 1);  // to make it smaller is to make the torque larger
}

TEST_CASE("the least is told where a step has a larger absolute value of the other sign") {
    const std::vector<double> ahead{-1e-3, 2e-3, 0};
    const auto found = told(design_of({torque(ahead, Over::least), torque(forwards, Over::least), torque(turns_back, Over::least)}));
    REQUIRE(found.size() == 1);
    CHECK(found[0].starts_with("objective `t0`: the least of the steps is -1 N mm, but step 2 has 2 N mm"));
}

TEST_CASE("nothing is said of the sign of peaks, means and what has no direction, nor where turning round is forbidden") {
    for (const Over over : {Over::end, Over::sum, Over::mean, Over::peak}) CHECK(told(design_of({torque(turns_back, over)})).empty());
    CHECK(told(design_of({torque(turns_back, Over::largest, false)})).empty());
    CHECK(told(design_of({}, {{torque(backwards, Over::largest), {.upper = -0.5e-3}}})).empty());
    CHECK(told(design_of({}, {{torque(backwards, Over::largest), {.upper = 5e-3}}})).size() == 1);
    CHECK(told(design_of({torque({1e-3, -1.005e-3, 0}, Over::largest)})).empty());  // as good as equal
    const Design unusable = design_of({torque(turns_back, Over::largest)});
    CHECK(doubtful_extremes(unusable, DesignEvaluation()).empty());
}

TEST_CASE("an extreme that falls on one step alone is told, with the steps beside it; bends and cliffs that the steps show are not") {
    std::vector<double> spike(9, 1e-3), bend, cliff;
    spike[4] = 2e-3;
    for (int t = 0; t < 9; ++t) {
        bend.push_back(2e-3 - 1e-5 * (t - 3.7) * (t - 3.7));
        cliff.push_back(t < 5 ? 1e-3 + 1e-4 * t : 4e-4 - 1e-3 * (t - 5));
    }
    const auto found = told(design_of({torque(spike, Over::largest), torque(bend, Over::largest), torque(cliff, Over::largest, false)}));
    for (const std::string& sentence : found) UNSCOPED_INFO(sentence);
    REQUIRE(found.size() == 1);
    CHECK(found[0].starts_with("objective `t0`: the largest, 2 N mm, falls on step 5 alone, at "));
    CHECK(found[0].find("(the steps before and after it have 1 N mm and 1 N mm)") != std::string::npos);
    for (double& number : spike) number = -number;
    CHECK(told(design_of({torque(spike, Over::peak), torque(spike, Over::mean)})).size() == 1);
    CHECK(told(design_of({torque(spike, Over::least, false)}))[0].starts_with("objective `t0`: the least, -2 N mm, falls on step 5 alone"));
    spike[4] = -1.001e-3;
    CHECK(told(design_of({torque(spike, Over::peak)})).empty());  // hardly above the others
}

TEST_CASE("one that several ask for is told once; expressions, scenarios and the worst are looked into") {
    const Shared one = torque(turns_back, Over::largest), other = torque(turns_back, Over::least);
    const auto expression = [](const std::string& text, const std::vector<quantities::NamedQuantity>& parts) -> Shared {
        return quantities::Expression::parse(text, parts).value();
    };
    CHECK(told(design_of({one, expression("2 * a", {{"a", one}})}, {{one, {}}})).size() == 1);
    const auto inside = told(design_of({expression("2 * a", {{"a", one}})}));
    REQUIRE(inside.size() == 1);
    CHECK(inside[0].find("0.001 N m") != std::string::npos);
    // Written out, a peak is a peak.
    CHECK(told(design_of({expression("max(a, -b)", {{"a", one}, {"b", other}})})).empty());
    CHECK(told(design_of({std::make_shared<quantities::Worst>(std::vector<Shared>{one, torque(forwards, Over::largest)}, true)})).size() ==
          1);

    Design design = design_of({});
    design.scenarios = {{"a", design.scene, {}, {}, 3}, {"b", design.scene, {}, {}, 3}};
    for (const int s : {0, 1})
        design.objective.push_back({"t [" + design.scenarios[s].name + "]", 1, 1e-3, std::make_shared<quantities::InScenario>(one, s)});
    const auto of_scenarios = told(design);
    REQUIRE(of_scenarios.size() == 1);
    CHECK(of_scenarios[0].starts_with("objective `t [a]`: "));
}

}  // namespace fettle::design::problem::doubtful_extremes_test
