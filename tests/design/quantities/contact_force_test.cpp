// SPDX-License-Identifier: MIT
// How far bodies are from touching, in place of a least force that they have lost: a ram that a motor drives against a pad on a spring.
// Closed forms, differences of whole simulations, and a search that begins without contact.
#include "design/quantities/contact_force.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "design/problem/optimiser_problem.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/quantities/file_problem.hpp"

namespace fettle::design::quantities::contact_force_test {

namespace {

using problem::DesignEvaluation;
using problem::DesignProblem;
using tests::design_support::problem_of;

constexpr double dhat = 5e-5, bound = 5, stiffness = bound / (10 * dhat);  // [m], [N], [N/m]

// The ram's face starts 3 mm above the pad, and goes down by `travel` until 0.15 s. Both have a rail along y.
std::string scene(const std::string& ram) {
    return R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.2, "integrator": "quasi_static",
               "contact": {"dhat": 0.05, "dmin": 0, "kappa": 1e5},
               "bodies": [{"name": "pad", "density": 1000, "rotation": [0, 0, 0], "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 10, "size_z": 20}}},
                          {"name": "far", "density": 1000, "shape": {"part": "box"}, "position": [0, -60, 0]},
                          {"name": "ram", "density": 1000, "position": [0, 12, 0], "shape": )" +
           ram + R"(}],
               "joints": [{"name": "soft", "type": "prismatic", "b": "pad", "point": [0, 0, 0], "axis": [0, 1, 0], "stiffness": 1e4},
                          {"name": "floor", "type": "prismatic", "b": "far", "point": [0, -60, 0], "axis": [0, 1, 0], "stiffness": 1e4},
                          {"name": "rail", "type": "prismatic", "b": "ram", "point": [0, 12, 0], "axis": [0, 1, 0]}],
               "motors": [{"name": "push", "joint": "rail", "travel": {"times": [0, 0.15, 0.2], "values": [0, -2, -2]}}]})";
}

const std::string box = R"({"part": "box", "dimensions": {"size_x": 8, "size_y": 8, "size_z": 8}})";
const std::string roller = R"({"part": "cylinder", "dimensions": {"radius": 4, "length": 8}, "counts": {"segments": 16}})";

std::string design(const std::string& constraints, const std::string& more = "") {
    return R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
               "parameters": [{"name": "travel", "value": 2, "lower": 0.5, "upper": 4.5}, {"name": "height", "value": 0, "lower": -1, "upper": 1}],
               "set": {"/motors/push/travel/values/1": "= -travel", "/motors/push/travel/values/2": "= -travel",
                       "/bodies/ram/position/1": "= 12 mm + height"},
               "constraints": [)" +
           constraints + "]" + more + "}";
}

constexpr const char* each_way = R"(
    {"type": "contact_force", "name": "end", "body": "pad", "of": "ram", "axis": [0, -1, 0], "lower": "5 N"},
    {"type": "contact_force", "name": "least", "body": "pad", "of": "ram", "axis": [0, -1, 0], "over": "least", "from": 0.1, "lower": "5 N"},
    {"type": "contact_force", "name": "at", "body": "pad", "axis": [0, -1, 0], "at": 0.184, "lower": "5 N"},
    {"type": "contact_force", "name": "other way", "body": "pad", "of": "ram", "axis": [0, 1, 0], "over": "largest", "from": 0.1, "upper": "-5 N"},
    {"type": "contact_force", "name": "magnitude", "body": "ram", "lower": "5 N"},
    {"type": "contact_torque", "name": "torque", "body": "ram", "point": [5, 0, 0], "axis": [0, 0, -1], "lower": "5 N mm"},
    {"type": "contact_force", "name": "largest", "body": "pad", "of": "ram", "over": "largest", "lower": "5 N"},
    {"type": "contact_force", "name": "not too much", "body": "pad", "of": "ram", "upper": "100 N"},
    {"type": "contact_force", "name": "mean", "body": "pad", "of": "ram", "over": "mean", "lower": "5 N"})";

VectorX parameters(double travel, double height = 0) { return Vector2(travel * 1e-3, height * 1e-3); }

DesignEvaluation evaluated(const DesignProblem& problem, const VectorX& p) {
    const DesignEvaluation at = problem.evaluate(p);
    INFO(at.reason);
    REQUIRE(at.usable);
    return at;
}

void check_derivatives(const DesignProblem& problem, const VectorX& p, double tolerance) {
    const MatrixX jacobian = search_jacobian(evaluated(problem, p));
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        constexpr double h = 1e-7;
        const VectorX step = h * VectorX::Unit(p.size(), k);
        const VectorX difference = (search_values(evaluated(problem, p + step)) - search_values(evaluated(problem, p - step))) / (2 * h);
        for (Eigen::Index i = 0; i < difference.size(); ++i) {
            if (problem.design().constraints[static_cast<std::size_t>(i)].name == "largest")
                continue;  // of equal steps, while the ram rests
            CAPTURE(problem.design().constraints[static_cast<std::size_t>(i)].name, k, p[0], jacobian(i, k), difference[i]);
            CHECK(jacobian(i, k) == Approx(difference[i]).epsilon(tolerance).margin(1e-6));
        }
    }
}

}  // namespace

TEST_CASE("a least force of parts that are apart is, for a search, how far they are from touching", "[contact]") {
    const DesignProblem problem = problem_of(scene(box), design(each_way));
    const DesignEvaluation at = evaluated(problem, parameters(2));
    const double end = -stiffness * (1e-3 - dhat), at_first = -stiffness * (3e-3 - 2e-3 * 0.1 / 0.15 - dhat);
    const VectorX seen = search_values(at);
    CHECK(seen[0] == Approx(end).epsilon(1e-6));
    CHECK(seen[1] == Approx(at_first).epsilon(1e-6));
    CHECK(seen[2] == Approx(end).epsilon(1e-6));
    CHECK(seen[3] == Approx(-at_first).epsilon(1e-6));
    CHECK(seen[4] == Approx(end).epsilon(1e-6));
    CHECK(seen[5] == Approx(1e-3 * end).epsilon(1e-6));
    for (Eigen::Index i = 6; i < seen.size(); ++i) CHECK(seen[i] == 0);  // as they are
    CHECK(at.continued.size() == 6);
    CHECK(search_jacobian(at)(0, 0) == Approx(stiffness));
    CHECK(search_jacobian(at)(0, 1) == Approx(-stiffness));
    // Reports stay as they are.
    for (const description::Measurement& force : at.constraints) CHECK(force.value == 0);
    CHECK(at.jacobian.isZero(0));
    CHECK(at.violation == Approx(5));
    CHECK(remark(at, 0) == "`pad` and `ram` are 1 mm apart");
    CHECK(remark(at, 7).empty());
    const optimisers::Evaluation told = problem::optimiser_evaluation(at);
    CHECK(told.constraints == seen);
    CHECK(told.measured.isZero(0));
    CHECK(told.violation == at.violation);
    // Farther apart is worse; where it presses enough nothing is continued.
    CHECK(search_values(evaluated(problem, parameters(1.5)))[0] < seen[0]);
    const DesignEvaluation pressed = evaluated(problem, parameters(4));
    CHECK(pressed.continued.size() == 2);  // the window begins before contact
    CHECK(search_values(pressed)[0] == pressed.constraints[0].value);
    CHECK(problem::optimiser_evaluation(evaluated(problem, parameters(4.5, -1))).measured.size() == 0);
}

TEST_CASE("rows of a least force have the derivatives of their differences, apart and pressed", "[contact]") {
    for (const std::string& ram : {box, roller}) {
        const DesignProblem problem = problem_of(scene(ram), design(each_way));
        for (const double travel : {1.2, 2.7, 3.3, 4.2}) check_derivatives(problem, parameters(travel, 0.1), 1e-5);
    }
}

TEST_CASE("the gap of parts that turn and change their shape has the derivatives of its differences", "[contact]") {
    std::string text = design(each_way);
    const auto put = [&](const std::string& key, const std::string& more) { text.insert(text.find(key) + key.size(), more); };
    put(R"("set": {)", R"("/bodies/pad/rotation/2": "= turn", "/bodies/ram/shape/dimensions/)");
    put(R"("parameters": [)",
        R"({"name": "turn", "unit": "deg", "value": 3, "lower": 0, "upper": 9}, {"name": "size", "value": 8, "lower": 5, "upper": 9},
           {"name": "dmin", "value": 0.01, "lower": 0, "upper": 0.02}, )");
    for (const std::string& ram : {box, roller}) {
        std::string own = text;
        const std::string key = "shape/dimensions/";
        own.insert(own.find(key) + key.size(), ram == box ? R"(size_y": "= size", "/contact/dmin": "= dmin", )"
                                                          : R"(radius": "= size / 2", "/contact/dmin": "= dmin", )");
        const DesignProblem problem = problem_of(scene(ram), own);
        VectorX p = description::values_of(problem.design().parameters);
        check_derivatives(problem, p, 1e-5);
    }
}

TEST_CASE("a row of a least force is continuous where contact begins, between round surfaces too", "[contact]") {
    for (const std::string& ram : {box, roller}) {
        const DesignProblem problem = problem_of(scene(ram), design(R"(
            {"type": "contact_force", "name": "end", "body": "pad", "of": "ram", "axis": [0, -1, 0], "lower": "5 N"})"));
        double apart = 2, touching = 3;
        while (touching - apart > 1e-6) {
            const double middle = 0.5 * (apart + touching);
            (evaluated(problem, parameters(middle)).continued.empty() ? touching : apart) = middle;
        }
        CHECK(std::abs(search_values(evaluated(problem, parameters(apart)))[0]) < 1e-3 * bound);
        CHECK(std::abs(search_values(evaluated(problem, parameters(touching)))[0]) < 1e-3 * bound);
    }
}

TEST_CASE("a search that begins without contact ends where the part is pressed as asked", "[contact]") {
    const DesignProblem problem = problem_of(
        scene(roller),
        design(
            R"({"type": "contact_force", "name": "presses", "body": "pad", "of": "ram", "axis": [0, -1, 0], "over": "least", "from": 0.16, "lower": "5 N"})",
            R"(, "objective": [{"type": "stroke", "body": "ram", "axis": [0, 1, 0], "weight": 1}], "optimiser": {"max_evaluations": 40})"));
    const auto outcome = studies::optimise_design(problem);
    REQUIRE(outcome);
    INFO(outcome->report.message);
    CHECK(outcome->report.feasible);
    CHECK(outcome->report.status == optimisers::OptimiserStatus::optimal);
    CHECK(outcome->final.constraints[0].value == Approx(bound).epsilon(1e-3));
}

}  // namespace fettle::design::quantities::contact_force_test
