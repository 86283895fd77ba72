// SPDX-License-Identifier: MIT
// A design with scenarios against designs that each have one of its settings as their own.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/base/parallel.hpp"
#include "core/files/atomic_file.hpp"
#include "design/gradient_audit/sweep_agreement.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/small_design.hpp"

namespace fettle::design::problem::scenarios_test {

namespace {

using fettle::tests::design_support::DesignFolder;
using fettle::tests::design_support::small_design;
using nlohmann::json;

const json tilted = json::parse(R"({"/gravity": [1, 0, -9.81], "/bodies/cube/density": "= 2 * density"})");
const json quick = json::parse(R"({"/bodies/table/prescribed/ry/rate": "= speed * 2", "/timestep": 0.004})");

json plain() { return json::parse(small_design); }

json with_scenarios() {
    json design = plain();
    design["scenarios"] = {{{"name", "as drawn"}}, {{"name", "tilted"}, {"set", tilted}}, {{"name", "quick"}, {"set", quick}}};
    return design;
}

// One scenario's setting as the design's own.
json alone(const json& set) {
    json design = plain();
    design["set"].update(set);
    return design;
}

Result<reading::DesignFile> read(const json& design) {
    const DesignFolder folder(design.dump());
    return reading::read_design(folder.design());
}

DesignProblem problem_of(const json& design) {
    auto file = read(design);
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    auto problem = DesignProblem::create(std::move(file->design));
    for (const Error& error : problem.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(problem);
    return std::move(problem).value();
}

VectorX start_of(const DesignProblem& problem) { return description::values_of(problem.design().parameters); }

bool is_told(const json& design, const std::string& where, const std::string& words) {
    const auto file = read(design);
    for (const Error& error : file.errors()) {
        if (error.where.ends_with(where) && error.message.find(words) != std::string::npos) return true;
        UNSCOPED_INFO(error.where << ": " << error.message);
    }
    return false;
}

}  // namespace

TEST_CASE("scenarios: each is the design with that setting, value for value and row for row") {
    const DesignProblem all = problem_of(with_scenarios());
    REQUIRE(all.scenario_count() == 3);
    const VectorX p = start_of(all);
    const DesignEvaluation at = all.evaluate(p);
    REQUIRE(at.usable);
    std::vector<DesignEvaluation> each;
    for (const json& set : {json::object(), tilted, quick}) each.push_back(problem_of(alone(set)).evaluate(p));
    // The mass term is the same in all but the tilted one, whose density is another: three terms of each.
    const std::size_t terms = each[0].terms.size(), constraints = each[0].constraints.size();
    REQUIRE(at.terms.size() == 3 * terms);
    REQUIRE(at.constraints.size() == 3 * constraints);
    double objective = 0;
    VectorX gradient = VectorX::Zero(p.size());
    for (std::size_t s = 0; s < 3; ++s) {
        REQUIRE(each[s].usable);
        for (std::size_t k = 0; k < terms; ++k) CHECK(at.terms[3 * k + s].value == each[s].terms[k].value);
        objective += each[s].objective / 3;
        gradient += each[s].gradient / 3;
        CHECK(at.runs[s].simulation.trajectory.poses.size() == each[s].runs[0].simulation.trajectory.poses.size());
    }
    CHECK(at.objective == Approx(objective).epsilon(1e-14));
    CHECK((at.gradient - gradient).norm() <= 1e-12 * gradient.norm());
    CHECK(at.residuals.squaredNorm() ==
          Approx((each[0].residuals.squaredNorm() + each[1].residuals.squaredNorm() + each[2].residuals.squaredNorm()) / 3));
    // Those of windows stand together: by name.
    for (std::size_t i = 0; i < at.constraints.size(); ++i) {
        const std::string& name = all.design().constraints[i].name;
        const std::size_t s = name.ends_with(" [as drawn]") ? 0 : name.ends_with(" [tilted]") ? 1 : 2;
        const std::string base = name.substr(0, name.rfind(" ["));
        const DesignProblem one = problem_of(alone(s == 0 ? json::object() : s == 1 ? tilted : quick));
        std::size_t k = 0;
        while (one.design().constraints[k].name != base) ++k;
        INFO(name);
        CHECK(at.constraints[i].value == each[s].constraints[k].value);
        CHECK(at.constraints[i].lower == each[s].constraints[k].lower);
        CHECK((at.jacobian.row(i) - each[s].jacobian.row(k)).norm() <= 1e-12 * each[s].jacobian.row(k).norm());
    }
    CHECK(at.violation == std::max({each[0].violation, each[1].violation, each[2].violation}));
    CHECK(at.constraint_branches.of.size() ==
          each[0].constraint_branches.of.size() + each[1].constraint_branches.of.size() + each[2].constraint_branches.of.size());
}

TEST_CASE("scenarios: a mass counts once where what they set changes no part, variables of loads included") {
    const DesignFolder folder(R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
        "parameters": [{"name": "width", "value": 10, "lower": 8, "upper": 12}, {"name": "v", "value": 1, "lower": 0, "upper": 2, "unit": "mm/s"}],
        "scenarios": [{"name": "free"}, {"name": "pushed", "set": {SET}}],
        "objective": [{"type": "mass", "bodies": ["stone"]}],
        "constraints": [{"type": "mass", "bodies": ["stone"], "upper": 4},
                        {"type": "stroke", "body": "stone", "axis": [1, 0, 0], "upper": 30}]})",
                              R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.05,
        "variables": {"v": "1mm/s", "width": "10mm", "length": "20mm", "push": "0 N", "half": "= length / 2"},
        "bodies": [{"name": "stone", "density": 1000, "linear_velocity": ["= v", 0, 0], "position": ["= half", 0, 0],
                    "shape": {"part": "box", "dimensions": {"size_x": "= length", "size_y": "= width"}}}],
        "loads": [{"name": "push", "body": "stone", "point": ["= half", 0, 0], "force": ["= push + 0.001 N", 0, 0]}]})");
    const auto counted = [&](const std::string& set) {
        auto text = core::files::read_file(folder.design());
        REQUIRE(text);
        const auto file = reading::parse_design(fettle::tests::design_support::replaced(*text, "SET", set), folder.design());
        for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
        REQUIRE(file);
        return std::pair(file->design.objective.size(), file->design.constraints.size());
    };
    const auto once = std::pair<std::size_t, std::size_t>(1, 3), twice = std::pair<std::size_t, std::size_t>(2, 4);
    CHECK(counted(R"("/gravity": [1, 0, 0])") == once);
    CHECK(counted(R"("/variables/push": "1 N", "/bodies/stone/linear_velocity": [3, 0, 0])") == once);
    CHECK(counted(R"("/variables/length": "21mm")") == twice);
    CHECK(counted(R"("/variables/half": "= 10mm + 0 * width")") == twice);  // here the same place, elsewhere by another formula
    CHECK(counted(R"("/variables/push": "1 N", "/bodies/stone/density": 900)") == twice);
}

TEST_CASE("scenarios: one that sets nothing is the design without, bit for bit; and so for any number of threads") {
    json one = plain();
    one["scenarios"] = {{{"name", "as drawn"}}};
    const DesignProblem scenario = problem_of(one), none = problem_of(plain());
    const VectorX p = start_of(none);
    const DesignEvaluation a = scenario.evaluate(p), b = none.evaluate(p);
    CHECK(a.objective == b.objective);
    CHECK(a.gradient == b.gradient);
    CHECK(a.jacobian == b.jacobian);
    const DesignProblem several = problem_of(with_scenarios());
    const DesignEvaluation many = several.evaluate(p);
    const core::base::ThreadLimit limit(1);
    const DesignEvaluation single = several.evaluate(p);
    CHECK(many.objective == single.objective);
    CHECK(many.gradient == single.gradient);
    CHECK(many.jacobian == single.jacobian);
}

TEST_CASE("scenarios: an expression of quantities of several, and of parameters, once") {
    json design = with_scenarios();
    design["quantities"] = json::parse(R"({
        "up": {"type": "stroke", "body": "cube", "axis": [0, 0, 1], "scenario": "as drawn"},
        "over": {"type": "stroke", "body": "cube", "axis": [0, 0, 1], "scenario": "tilted"}, "any": {"type": "stroke", "body": "cube", "axis": [1, 0, 0]}})");
    design["objective"] = json::parse(R"([{"type": "expression", "expression": "(over - up) * width / 1 mm + 3 * width"},
                                          {"type": "expression", "expression": "any * any / width", "scenario": "quick", "weight": 2}])");
    design["constraints"] = json::array();
    const DesignProblem problem = problem_of(design);
    REQUIRE(problem.design().objective.size() == 2);
    CHECK(problem.design().objective[1].name.ends_with(" [quick]"));
    const VectorX p = start_of(problem);
    const DesignEvaluation at = problem.evaluate(p);
    REQUIRE(at.usable);
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const double range = problem.design().parameters[k].upper - problem.design().parameters[k].lower, h = 1e-5 * range;
        VectorX above = p, below = p;
        above[k] += h;
        below[k] -= h;
        const double difference =
            (problem.evaluate(above, {false, {}, {}}).objective - problem.evaluate(below, {false, {}, {}}).objective) / (2 * h);
        INFO(problem.design().parameters[k].name);
        CHECK(at.gradient[k] * range == Approx(difference * range).epsilon(1e-5).margin(1e-6 * std::abs(at.objective)));
    }
}

TEST_CASE("scenarios: the worst of them, whose optimum lies where two are equally bad") {
    // Two stones fall sideways in opposite winds; their start is moved so that the farther one does not get far.
    const fettle::tests::support::TemporaryFolder folder;
    folder.write("stone.scene.json", R"({"fettle_scene": 1, "units": "mm", "timestep": 0.01, "end_time": 0.1,
        "bodies": [{"name": "stone", "density": 1000, "shape": {"part": "box"}, "linear_velocity": ["= v", 0, 0]}], "variables": {"v": "1mm/s"}})");
    const auto written = [&](const std::string& weight) {
        return R"({"fettle_design": 1, "scene": "stone.scene.json", "units": "mm",
            "parameters": [{"name": "v", "unit": "mm/s", "value": 90, "lower": -200, "upper": 300}],
            "scenarios": [{"name": "west", "set": {"/gravity": [2, 0, 0]}}, {"name": "east", "set": {"/gravity": [-1, 0, 0]}}],
            "objective": [{"type": "marker_path", "name": "off", "body": "stone", "point": [0, 0, 0], "points": [[5, 0, 0]], "times": [0.1],
                           "scenario": "worst", "weight": )" +
               weight + R"(}], "optimiser": {"tolerance": 1e-6}})";
    };
    auto file = reading::parse_design(written("1"), folder.file("stone.design.json"));
    for (const Error& error : file.errors()) UNSCOPED_INFO(error.where << ": " << error.message);
    REQUIRE(file);
    REQUIRE(file->design.objective.size() == 1);
    CHECK(file->design.objective[0].name == "off [worst]");
    const auto problem = DesignProblem::create(file->design);
    REQUIRE(problem);
    // Where the stone ends is linear in v; off^2 of the two are equal where the two ends lie about the target.
    const VectorX p = VectorX::Constant(1, 0.09);
    const DesignEvaluation at = problem->evaluate(p);
    REQUIRE(at.usable);
    const double west = at.terms[0].parts[0].value, east = at.terms[0].parts[1].value;
    CHECK(at.objective * 1e-6 == Approx(std::max(west, east)));
    REQUIRE(at.objective_branches.of.size() == 2);
    CHECK(at.objective_branches.values[0] == Approx(at.objective));
    for (int k = 0; k < 2; ++k) {
        const double h = 1e-6;
        const auto value = [&](double v) {
            const DesignEvaluation there = problem->evaluate(VectorX::Constant(1, v), {false, {}, {}});
            const bool is_west = (k == 0) == (west > east);
            return there.terms[0].parts[is_west ? 0 : 1].value * 1e6;
        };
        CHECK(at.objective_branches.jacobian(k, 0) == Approx((value(0.09 + h) - value(0.09 - h)) / (2 * h)).epsilon(1e-5));
    }
    const auto outcome = studies::optimise_design(*problem, {});
    REQUIRE(outcome);
    CHECK(outcome->report.status == optimisers::OptimiserStatus::optimal);
    const description::Measurement& best = outcome->final.terms[0];
    CHECK(best.parts[0].value == Approx(best.parts[1].value).epsilon(1e-3));
    CHECK(outcome->report.evaluations < 20);

    // What is to be large: the least of them.
    auto largest = reading::parse_design(written("-1"), folder.file("stone.design.json"));
    REQUIRE(largest);
    const DesignEvaluation least = DesignProblem::create(largest->design)->evaluate(p);
    CHECK(least.terms[0].value == std::min(west, east));
}

TEST_CASE("scenarios: the check of gradients compares its sweeps in each") {
    const DesignProblem problem = problem_of(with_scenarios());
    const VectorX p = start_of(problem);
    const gradient_audit::SweepAgreement sweeps = gradient_audit::compare_sweeps(problem, problem.evaluate(p));
    CHECK(sweeps.failure.empty());
    CHECK(sweeps.disagreement < 1e-9);
    // A motion that was not simulated from its model is noticed, whichever scenario it is of.
    DesignEvaluation wrong = problem.evaluate(p);
    wrong.runs[2].simulation.trajectory.poses[3][1].position.z() += 1e-6;
    wrong.runs[2].simulation.trajectory.steps[2].nodes.back()[1].position.z() += 1e-6;
    const gradient_audit::SweepAgreement noticed = gradient_audit::compare_sweeps(problem, wrong);
    CHECK((!noticed.failure.empty() || noticed.disagreement > 1e-9));
}

TEST_CASE("scenarios: what no scenario changes is measured once") {
    json design = plain();
    design["scenarios"] =
        json::parse(R"([{"name": "a"}, {"name": "b", "set": {"/gravity": [0, 1, -9.81], "/bodies/table/prescribed/ry/rate": 20}}])");
    const DesignProblem problem = problem_of(design);
    int masses = 0;
    for (const auto& term : problem.design().objective) masses += term.name.starts_with("mass") ? 1 : 0;
    CHECK(masses == 1);
    const DesignEvaluation at = problem.evaluate(start_of(problem));
    CHECK(at.usable);
    CHECK(problem.rest_rows(start_of(problem))->values.size() == static_cast<Eigen::Index>(problem.rest_constraints().size()));
}

TEST_CASE("scenarios: the play taken up one way and the other is gravity with a press along an axis, and against it") {
    json design = plain();
    design["scenarios"] = {{{"name", "as it lies"}}, {{"name", "pressed"}, {"play", "both"}, {"along", {3, 0, 4}}, {"press", 5}}};
    const DesignProblem all = problem_of(design);
    const auto& scenarios = all.design().scenarios;
    REQUIRE(scenarios.size() == 3);
    CHECK(scenarios[1].name == "pressed forwards");
    CHECK(scenarios[2].name == "pressed backwards");
    const Vector3 own = scenarios[0].scene.gravity;
    CHECK((scenarios[1].scene.gravity - own - Vector3(3, 0, 4)).norm() < 1e-14);
    CHECK((scenarios[2].scene.gravity - own + Vector3(3, 0, 4)).norm() < 1e-14);
    const VectorX p = start_of(all);
    const DesignEvaluation at = all.evaluate(p);
    REQUIRE(at.usable);
    const DesignEvaluation same = problem_of(alone({{"/gravity", {own.x() + 3, own.y(), own.z() + 4}}})).evaluate(p);
    REQUIRE(same.usable);
    const auto& poses = at.runs[1].simulation.trajectory.poses.back();
    for (std::size_t body = 0; body < poses.size(); ++body)
        CHECK(poses[body].position == same.runs[0].simulation.trajectory.poses.back()[body].position);

    design["scenarios"] = {{{"name", "pressed"}, {"play", "both"}}};
    CHECK(is_told(design, "/scenarios/0", "along"));
    design["scenarios"] = {{{"name", "pressed"}, {"play", "both"}, {"along", {0, 0, 0}}}};
    CHECK(is_told(design, "/scenarios/0/along", "length 0"));
    design["scenarios"] = {{{"name", "pressed"}, {"along", {1, 0, 0}}}};
    CHECK(is_told(design, "/scenarios/0/along", "goes with"));
    design["scenarios"] = {{{"name", "pressed forwards"}}, {{"name", "pressed"}, {"play", "both"}, {"along", {1, 0, 0}}}};
    CHECK(is_told(design, "/scenarios/1/name", "another scenario"));
}

TEST_CASE("scenarios: faults have their place") {
    json design = with_scenarios();
    design["scenarios"][1]["name"] = "quick";
    CHECK(is_told(design, "/scenarios/2/name", "another scenario"));
    design["scenarios"][1]["name"] = "";
    CHECK(is_told(design, "/scenarios/1/name", "has a name"));
    design["scenarios"][1]["name"] = "all";
    CHECK(is_told(design, "/scenarios/1/name", "several"));
    design = with_scenarios();
    design["scenarios"][1]["set"]["/bodies/cubes/density"] = 1;
    CHECK(is_told(design, "~1cubes~1density", "cube"));
    design = with_scenarios();
    design["scenarios"][1]["set"]["/bodies/0/name"] = "desk";
    CHECK(is_told(design, "/scenarios/1/set", "the scene's bodies"));
    design = with_scenarios();
    design["objective"][0]["scenario"] = "quik";
    CHECK(is_told(design, "/objective/0/scenario", "quick"));
    design = plain();
    design["objective"][0]["scenario"] = "all";
    CHECK(is_told(design, "/objective/0/scenario", "no `scenarios`"));
    design["scenarios"] = json::array();
    CHECK(is_told(design, "/scenarios", "has one"));
    design["scenarios"] = 3;
    CHECK_FALSE(read(design));
}

}  // namespace fettle::design::problem::scenarios_test
