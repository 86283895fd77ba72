// SPDX-License-Identifier: MIT
// What the program says to people: each line must be understood by one who has read nothing else, with place, finding and remedy.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "design/cli/optimise_answer.hpp"
#include "design/description/requirement_text.hpp"
#include "tests/design/small_design.hpp"
#include "tests/design/small_problem.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::cli::messages_test {

namespace {

using namespace fettle::tests::design_support;
using fettle::tests::support::Answer;
using fettle::tests::support::box_mesh;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using fettle::tests::support::TemporaryFolder;

const std::string crank = "examples/slider_crank/slider_crank.scene.json";

// What is said to bad input: exit code 3 and these words.
void refused(const std::string& arguments, const std::vector<std::string>& words) {
    const Answer answer = run(arguments, true);
    CAPTURE(arguments, answer.out);
    CHECK(answer.code == 3);
    for (const std::string& word : words) CHECK(answer.says(word));
}

}  // namespace

TEST_CASE("messages: options and words that are not taken name what was probably meant") {
    refused("simulate " + crank + " --stpes 9", {"there is no option --stpes; did you mean --steps?", "see fettle simulate --help"});
    refused("simulate --stpes 9 " + crank, {"there is no option --stpes; did you mean --steps?"});
    refused("export " + crank + " --tto x.stl", {"there is no option --tto; did you mean --to?"});
    refused("simulate a b", {"\"b\" is one word too many: `simulate` takes SCENE"});
    refused("simulate", {"SCENE is missing: Scene or design", "see fettle simulate --help"});
    refused("export " + crank, {"--to is missing"});
    refused("simulate " + crank + " --steps", {"--steps: a whole number is expected after it"});
    refused("clearance " + crank + " --process", {"--process: a value is expected after it"});
    refused("simulate " + crank + " --steps 99999999999", {"99999999999 is out of range: a whole number of at most 2147483647"});
    refused("simulate " + crank + " --steps 2.5", {"a whole number is expected, found \"2.5\""});
    refused("simulate " + crank + " --steps 3 --time 1", {"--steps", "--time", "do not go together"});
    refused("", {"no command was given"});
    for (const std::string before : {"", "--quiet ", "--threads 1 "})
        refused(before + "valdate x", {"there is no command \"valdate\"; did you mean \"validate\"?"});
    const Answer unknown = run("frobnicate", true);
    CHECK(unknown.says("there is no command \"frobnicate\"; there are new, "));
    for (const char* before : {"", "--json ", "--quiet --threads 2 "}) {
        const Answer misspelt = run(before + ("valdate " + crank), true);
        CAPTURE(misspelt.out);
        CHECK(misspelt.code == 3);
        CHECK(misspelt.says("did you mean "));
        CHECK(misspelt.says("validate"));
    }
}

TEST_CASE("messages: why nothing is judged") {
    const std::string body = R"("density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 4, "size_y": 4, "size_z": 4}}})";
    const DesignFolder folder;
    const auto said = [&](const std::string& more, const std::string& words) {
        const std::string scene =
            folder.write("two.scene.json", R"({"fettle_scene": 1, "units": "mm", "bodies": [{"name": "a", "group": 1, )" + body +
                                               R"(, {"name": "b", "position": [20, 0, 0], )" + more);
        const Answer answer = run("clearance " + scene + " --minimum 1mm", true);
        CAPTURE(answer.out);
        CHECK(answer.code == 2);
        CHECK(answer.says("nothing was judged: " + words));
    };
    said("\"group\": 1, " + body + "]}", "all bodies are of one group");
    said(body + R"(], "joints": [{"name": "hinge", "type": "revolute", "a": "a", "b": "b", "point": [10, 0, 0], "axis": [0, 0, 1]}]})",
         "a joint joins the bodies of every pair");
}

TEST_CASE("messages: a format's key that is misspelt, and folders that are not there") {
    const DesignFolder folder;
    const std::string scene = folder.write("a.scene.json", "{\"fetle_scene\": 1, \"units\": \"mm\"}");
    refused("validate " + scene, {"did you mean `fettle_scene`, where `fetle_scene` stands?"});
    const std::string design = folder.write("a.design.json", "{\"fettle_desing\": 1, \"scene\": \"a.scene.json\"}");
    refused("validate " + design, {"did you mean `fettle_design`, where `fettle_desing` stands?"});
    refused("optimise " + design, {"did you mean `fettle_design`, where `fettle_desing` stands?"});
    const Answer nowhere = run("validate " + crank + " --mesh-dir " + folder.file("nosuch"), true);
    CHECK(nowhere.code == 0);
    CHECK(nowhere.says("nosuch: there is no such folder"));
    // The file that was asked for is named, not its folder.
    const std::string csv = folder.file("small.scene.json/x.csv");
    refused("clearance " + crank + " --csv " + csv, {"error: " + csv});
    refused("draw " + crank + " --out /proc/none/x.png", {"error: /proc/none/x.png"});
    refused("export " + crank + " --to /proc/none/x.stl", {"error: /proc/none/x.stl"});
    refused("validate " + crank + " --log /proc/none/x.txt", {"error: /proc/none/x.txt"});
}

TEST_CASE("messages: a file that cannot be written is told by the name it was given") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json"), in_file = folder.write("file", "") + "/deep/x.csv";
    for (const char* option : {" --csv ", " --log "}) refused("clearance " + scene + option + in_file, {in_file});
}

TEST_CASE("messages: an empty value, as of a variable that is not set, is no option left out") {
    for (const std::string option : {"--minimum", "--pairs", "--process", "--out", "--certificate"})
        refused("clearance " + crank + " " + option + " ''", {option + ": a value is expected, found an empty text"});
}

TEST_CASE("messages: steps of no motion are refused, not passed over") {
    refused("clearance " + crank + " --steps 3", {"--steps", "add --motion or --kinematic"});
    refused("clearance " + crank + " --time 1", {"--time", "add --motion or --kinematic"});
}

TEST_CASE("messages: files of another version, and a scene that is not there") {
    const TemporaryFolder folder;
    refused("validate " + folder.write("nine.scene.json", R"({"fettle_scene": 9, "units": "mm", "bodies": []})"),
            {"#/fettle_scene: a file of version 9 is not read: this program reads version 1; was it written for a newer fettle?"});
    refused("validate " + folder.write("nine.design.json", R"({"fettle_design": 9, "scene": "nine.scene.json"})"),
            {"#/fettle_design: a file of version 9 is not read"});
    const std::string alone = folder.write("alone.design.json", R"({"fettle_design": 1, "scene": "gone.scene.json", "units": "mm"})");
    refused("validate " + alone, {alone + "#/scene: there is no scene file " + folder.file("gone.scene.json"), "[file_not_found]"});
    refused("validate " + folder.write("half.scene.json", R"({"fettle_scene": 1, "units": "mm", "timestep": -1,
                "bodies": [{"name": "a", "mesh": "a.stl"}]})"),
            {"it must be at least 1e-12 and at most 1000000000"});
}

TEST_CASE("messages: a motor without a joint is told once, by what is missing") {
    const TemporaryFolder folder;
    const Answer answer = run("validate " + folder.write("motor.scene.json", R"({"fettle_scene": 1, "units": "mm",
        "bodies": [{"name": "a", "shape": {"part": "box", "dimensions": {"size_x": 1, "size_y": 1, "size_z": 1}}}],
        "joints": [{"name": "hinge", "type": "revolute", "b": "a", "point": [0, 0, 0], "axis": [0, 0, 1]}],
        "motors": [{"name": "drive"}]})"),
                              true);
    CHECK(answer.code == 3);
    CHECK(answer.says("the key `joint` is required here"));
    CHECK_FALSE(answer.says("``"));
}

TEST_CASE("messages: one part, or one part twice, is no question of clearance") {
    const TemporaryFolder folder;
    const core::geometry::Mesh box = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01});
    const std::string file = folder.write("a.stl", core::mesh_files::stl_bytes({{"a", &box}}));
    refused("clearance " + file + " --unit mm --minimum 1mm", {file + ": is one part, and a clearance is between two"});
    refused("clearance " + file + " " + file + " --unit mm --minimum 1mm", {file + ": is named twice"});
    refused("clearance " + folder.path.string() + " " + file + " --unit mm --minimum 1mm", {"is named twice"});
}

TEST_CASE("messages: what is not there is said so before anything is asked of it") {
    const TemporaryFolder folder;
    const core::geometry::Mesh box = box_mesh({0, 0, 0}, {0.01, 0.01, 0.01});
    const std::string mesh = folder.write("a.stl", core::mesh_files::stl_bytes({{"a", &box}})), none = folder.file("nope.stl");
    const Answer alone = run("clearance " + none, true);
    CHECK(alone.code == 3);
    CHECK(alone.says(none + ": no such file"));
    CHECK_FALSE(alone.says("unit"));
    refused("clearance " + mesh + " " + folder.file("nope.txt") + " --unit mm", {folder.file("nope.txt") + ": no such file"});
    refused("report " + folder.file("nope.jsonl"), {folder.file("nope.jsonl") + ": there is no such file or folder"});
    refused("clearance " + folder.path.string() + " --ranges", {"is a folder: --ranges wants a scene or design"});
}

TEST_CASE("messages: a trajectory where a scene or design is expected is called one") {
    const DesignFolder folder;
    REQUIRE(run("simulate " + folder.file("small.scene.json") + " --steps 1 --no-report --out " + folder.file("out")).code == 0);
    const std::string path = folder.file("out/trajectory.json");
    refused("simulate " + path, {path + ": is a trajectory, not a scene; "});
    refused("export " + path + " --to " + folder.file("a.urdf"), {path + ": is a trajectory, not a scene; "});
    refused("gradient " + path, {path + ": is a trajectory, not a design; "});
}

TEST_CASE("messages: lengths are in the file's unit, and one step is one step") {
    const DesignFolder folder;
    const Answer one = run("simulate " + folder.file("small.scene.json") + " --steps 1");
    CAPTURE(one.out);
    CHECK(one.says("ok after 1 step, "));
    CHECK(one.says("smallest distance of two bodies over the path: at least 0."));
    CHECK(one.says(" mm, proven"));
    CHECK(run("clearance " + folder.file("small.scene.json") + " --motion --steps 1").says("(1 step, 0.005 s)"));
    CHECK(core::base::counted(0, "step") == "0 steps");
    CHECK(core::base::length_text(6.8e-5, 1e-3) == "0.068 mm");
    CHECK(core::base::length_text(0.0254, 0.0254) == "1 in");
    CHECK(core::base::length_text(2, 0.37) == "2 m");  // a unit without a name
}

TEST_CASE("messages: each evaluation says which requirement it misses, by how much, and what it is for") {
    const DesignFolder folder;
    const Answer answer = run("optimise " + folder.design() + " --optimiser sqp --details --no-report --out " + folder.file("out"), true);
    CAPTURE(answer.out);
    CHECK(answer.says("meets every requirement"));
    CHECK(answer.says("the best so far"));
    CHECK_FALSE(answer.says("violation "));
    CHECK(answer.says(", required at least 15 mm: "));
    CHECK(answer.says(", required 1.5 to 4 g: "));
    CHECK(answer.says("mass cube"));
    CHECK(answer.says(", counts "));  // what the objective is made of
    for (const char* strange : {"inf]", "in the file's unit", "is worth", "kappa", "residual", "held by: "})
        CHECK_FALSE(answer.says(strange));
}

TEST_CASE("messages: limits are whole numbers, and a coordinate that is 0 but for rounding is 0") {
    CHECK(run("optimise examples/slider_crank/slider_crank.design.json --seed -1", true).says("-1 is not allowed: 0 to 2000000000 is"));
    const Answer explained = run("clearance examples/follower/follower.scene.json --minimum 0.3mm --explain");
    CHECK(explained.says(", at ("));
    CHECK_FALSE(explained.says("e-17, "));
}

TEST_CASE("requirements in words") {
    using description::Bounds;
    CHECK(description::required_text({.lower = 3e-4, .unit = 1e-3}, "mm") == "at least 0.3 mm");
    CHECK(description::required_text({.upper = 2}, "") == "at most 2");
    CHECK(description::required_text({.lower = 0.02995, .upper = 0.03005, .unit = 1e-3}, "mm") == "29.95 to 30.05 mm");
    CHECK(description::required_text({.lower = 1, .upper = 1}, "") == "exactly 1");
    description::Measurement measured;
    measured.lower = 3.02e-4;
    measured.upper = 3.04e-4;
    CHECK(description::known_text(measured, {.unit = 1e-3}, "mm") == "computed 0.302 to 0.304 mm");
    measured.is_proven = true;
    CHECK(description::known_text(measured, {.unit = 1e-3}, "mm") == "proven 0.302 to 0.304 mm");
    measured.upper = measured.lower;
    CHECK(description::known_text(measured, {.unit = 1e-3}, "mm") == "proven 0.302 mm");
    // What is printed is proven: 3e-4 is not, of either.
    measured.lower = measured.upper = 2.99999999e-4;
    CHECK(description::known_text(measured, {.lower = 3e-4, .unit = 1e-3}, "mm") == "proven 0.2999999 mm");
    CHECK(description::bound_text(2.99999999e-4, description::Towards::down, 1e-3, "mm") == "0.2999999 mm");
    measured.lower = measured.upper = 3.00000001e-4;
    CHECK(description::known_text(measured, {.upper = 3e-4, .unit = 1e-3}, "mm") == "proven 0.3000001 mm");
    measured.lower = 2.9999996e-4;
    measured.upper = 3.04000004e-4;
    CHECK(description::known_text(measured, {.unit = 1e-3}, "mm") == "proven 0.2999999 to 0.3040001 mm");
    for (const double least : {4.9406564584124654e-324, 1e-320, 3.3e-310})  // comes to an end
        CHECK(std::strtod(description::bound_text(least, description::Towards::down, 1, "").c_str(), nullptr) <= least);
    CHECK(description::bound_text(-INFINITY, description::Towards::down, 1e-3, "mm") == "-inf mm");
    CHECK(core::base::unit_name(core::base::Dimension::area, 1e-3 * 1e-3) == "mm^2");
    CHECK(core::base::unit_name(core::base::Dimension::number, 1).empty());
}

TEST_CASE("what is met as written and not with the play taken up is in doubt, and said so first") {
    const problem::DesignProblem problem = problem_of(DesignFolder());
    const description::Design& design = problem.design();
    studies::OptimiseOutcome outcome;
    outcome.report.status = optimisers::OptimiserStatus::optimal;
    outcome.report.message = "sqp: no change near by promises a gain above the tolerance";
    outcome.start = outcome.report.point = description::values_of(design.parameters);
    outcome.report.best.usable = outcome.final.usable = outcome.play_taken_up.usable = true;
    outcome.report.feasible = true;
    for (const description::Constraint& constraint : design.constraints) {
        const double met = std::isfinite(constraint.bounds.upper) ? 0.5 * (constraint.bounds.lower + constraint.bounds.upper)
                                                                  : constraint.bounds.lower + constraint.bounds.unit;
        outcome.final.constraints.push_back(description::computed(met));
    }
    outcome.play_taken_up.constraints = outcome.final.constraints;
    CHECK(studies::requirements_in_doubt(design, outcome.final, outcome.play_taken_up).empty());
    const std::size_t stroke = 3;
    REQUIRE(design.constraints[stroke].name.find("stroke") == 0);
    outcome.play_taken_up.constraints[stroke] = description::computed(design.constraints[stroke].bounds.upper + 1e-3);
    outcome.in_doubt = studies::requirements_in_doubt(design, outcome.final, outcome.play_taken_up);
    CHECK(outcome.in_doubt == std::vector<std::size_t>{stroke});
    outcome.play_taken_up_by = "contact 0.28 mm wide";
    const std::string told = outcome_text(design, outcome, Console({}), {"out"});
    CAPTURE(told);
    CHECK(told.find("in doubt: this holds for the motion as simulated; with the play of the fits taken up 1 requirement is not met") <
          told.find("objective "));
    CHECK(told.find("31 mm, as written 15 mm, required 0 to 30 mm: NOT MET") != std::string::npos);
    CHECK(told.find("What to do: ") != std::string::npos);
    const auto checks = outcome_checks(design, outcome, "a.design.json");
    REQUIRE(checks.size() == design.constraints.size() + 1);
    CHECK(checks[stroke].outcome == CheckOutcome::remarked);
    outcome.play_taken_up.usable = false;
    CHECK(studies::requirements_in_doubt(design, outcome.final, outcome.play_taken_up).empty());
}

TEST_CASE("what rests on facets and time steps is told in few lines, what flips first, and is data") {
    const problem::DesignProblem problem = problem_of(DesignFolder());
    const description::Design& design = problem.design();
    studies::OptimiseOutcome outcome;
    outcome.report.status = optimisers::OptimiserStatus::optimal;
    outcome.start = outcome.report.point = description::values_of(design.parameters);
    outcome.report.best.usable = outcome.final.usable = outcome.report.feasible = true;
    for (const description::Constraint& constraint : design.constraints) {
        const double met = std::isfinite(constraint.bounds.upper) ? 0.5 * (constraint.bounds.lower + constraint.bounds.upper)
                                                                  : constraint.bounds.lower + constraint.bounds.unit;
        outcome.final.constraints.push_back(description::computed(met));
    }
    for (std::size_t k = 0; k < design.objective.size(); ++k) outcome.final.terms.push_back(description::computed(1));
    outcome.final.objective = outcome.report.best.objective = 10;
    const auto told = [&] { return outcome_text(design, outcome, Console({}), {"out"}); };
    const auto json = [&] { return answers::outcome_json(problem, outcome, {"out"}).at("resolution"); };
    CHECK(told().find("resolution") == std::string::npos);
    CHECK(json().is_null());

    studies::FinerRun finer{"with twice the facets", "finer_facets", "", 10, outcome.final.terms, outcome.final.constraints};
    outcome.finer.runs = {finer};
    CHECK(told().find("resolution: with twice the facets no requirement's number changes by more than 0.1%, and what is met stays met\n") !=
          std::string::npos);
    CHECK(json().at("flips").empty());

    const std::size_t stroke = 3;
    finer.constraints[stroke] = description::computed(design.constraints[stroke].bounds.upper + 1e-3);
    finer.constraints[0] = description::computed(1.05 * outcome.final.constraints[0].value);
    finer.terms[0] = description::computed(1 + 1e-6);  // as nothing in the objective
    finer.objective = 10.5;
    outcome.finer.runs = {finer};
    CAPTURE(told());
    CHECK(told().find("31 mm with twice the facets, as found 15 mm (52%), required 0 to 30 mm: NOT MET") <
          told().find("mm with twice the facets, as found 16 mm (4.8%)\n"));
    CHECK(told().find("the best design would have an objective of about 10.5 with twice the facets, as found 10 (4.8%)") !=
          std::string::npos);
    CHECK(told().find("mass cube", told().find("resolution: ")) == std::string::npos);
    CHECK(json().at("flips") == nlohmann::ordered_json({design.constraints[stroke].name}));
    CHECK(json().at("constraints")[stroke].at("met") == true);
    CHECK(json().at("constraints")[stroke].at("met_finer") == false);
    CHECK(json().at("constraints")[stroke].at("finer_facets").get<double>() == Approx(0.031));
    CHECK(json().at("runs")[0].at("change_of_best").get<double>() == Approx(0.5));
}

TEST_CASE("relations that hold a design are told with what they cost, and are what limits it") {
    const DesignFolder folder(replaced(small_design, R"({ "type": "mass", "bodies": ["cube"], "lower": 1.5, "upper": 4 })",
                                       R"({ "type": "mass", "bodies": ["cube"], "lower": 1.5, "upper": 4 },
        { "type": "relation", "name": "slender", "expression": "width / height", "lower": 1.5 },
        { "type": "relation", "name": "flat", "expression": "height", "upper": "14 mm" })"));
    const problem::DesignProblem problem = problem_of(folder);
    const description::Design& design = problem.design();
    REQUIRE(design.relations.size() == 2);
    studies::OptimiseOutcome outcome;
    outcome.report.status = optimisers::OptimiserStatus::optimal;
    outcome.start = outcome.report.point = description::values_of(design.parameters);
    outcome.report.best.usable = outcome.report.feasible = true;
    outcome.report.best.objective = 2;
    const auto m = static_cast<Eigen::Index>(design.constraints.size());
    optimisers::Optimality& o = outcome.report.optimality;
    o.judged = true;
    o.worth = 1e-3;
    o.step = o.residual = VectorX::Zero(outcome.start.size());
    o.held.assign(design.parameters.size(), optimisers::Held::constraints);
    o.multipliers = VectorX::Zero(m + 2);
    o.multipliers[m - 1] = 0.1 / design.constraints[m - 1].bounds.unit;
    o.multipliers[m] = 0.5;
    const nlohmann::ordered_json json = answers::outcome_json(problem, outcome, {"out"});
    CHECK(json.at("limited_by") == nlohmann::ordered_json({"slender", design.constraints[m - 1].name}));
    CHECK(json.at("optimality").at("relation_multipliers") == nlohmann::ordered_json({{"slender", 0.5}, {"flat", 0}}));
    const std::string told = outcome_text(design, outcome, Console({}), {"out"});
    CAPTURE(told);
    CHECK(told.find("slender: with a lower limit that is 0.01 lower, the objective could be lower by 0.005 (0.25% of it)") <
          told.find(design.constraints[m - 1].name + ": with a lower limit"));
}

TEST_CASE("why a feasible design is not shown to be optimal is told once, alike to people and to programs") {
    const problem::DesignProblem problem = problem_of(DesignFolder());
    const description::Design& design = problem.design();
    studies::OptimiseOutcome outcome;
    outcome.start = outcome.report.point = description::values_of(design.parameters);
    outcome.report.best.usable = outcome.report.feasible = true;
    outcome.report.best.objective = 2;
    outcome.report.status = optimisers::OptimiserStatus::feasible;
    optimisers::Optimality& o = outcome.report.optimality;
    const auto n = outcome.start.size(), m = static_cast<Eigen::Index>(design.constraints.size());
    o.judged = true;
    o.step = o.residual = VectorX::Zero(n);
    o.multipliers = VectorX::Zero(m);
    o.held.assign(n, optimisers::Held::stationary);
    o.worth = 1e-3;
    const auto why = [&] {
        const nlohmann::ordered_json json = answers::outcome_json(problem, outcome, {"out"});
        const nlohmann::ordered_json& told = json.at("why_not_optimal");
        const std::string text = told.is_null() ? "" : told.get<std::string>();
        const std::string shown = outcome_text(design, outcome, Console({}), {"out"});
        CHECK((shown.find("not shown to be optimal: " + text + "\n") != std::string::npos) == !text.empty());
        return text;
    };
    // Too rough: no step is in sight, whatever the gain of the last one looked at.
    o.roughest = 1;
    o.noise_in_objective = 0.0154;
    o.predicted_gain = 1e-4;
    std::string text = why();
    CHECK(text.find("simulated values scatter by up to 0.0154 in the objective (the tolerance is 0.001), most of it by " +
                    design.constraints[0].name) == 0);
    CHECK(text.find("in sight") == std::string::npos);
    o.improvable = {0};
    o.predicted_gain = 0.1;
    text = why();
    CHECK(text.find(
              "a change is still in sight that promises to lower the objective by 0.1, 5% of it (the tolerance is 0.001); simulated") == 0);
    o.roughest = -1;
    CHECK(why() == "a change is still in sight that promises to lower the objective by 0.1, 5% of it (the tolerance is 0.001)");
    outcome.report.budget_spent = true;
    CHECK(why().find("the budget of evaluations (`max_evaluations`) ended the search; a change") == 0);
    outcome.report.budget_spent = o.judged = false;
    o.improvable.clear();
    CHECK(why() == "whether a better design is near could not be judged");
    outcome.report.status = optimisers::OptimiserStatus::optimal;
    CHECK(why().empty());
}

TEST_CASE("what a requirement costs is said of the limit that holds") {
    const problem::DesignProblem problem = problem_of(DesignFolder());
    description::Design design = problem.design();
    studies::OptimiseOutcome outcome;
    outcome.start = outcome.report.point = description::values_of(design.parameters);
    outcome.report.best.usable = outcome.report.feasible = true;
    outcome.report.best.objective = 1;
    optimisers::Optimality& optimality = outcome.report.optimality;
    optimality.step = VectorX::Zero(outcome.start.size());
    optimality.multipliers = VectorX::Zero(design.constraints.size());
    const Eigen::Index clearance = 0, stroke = 3;
    REQUIRE(design.constraints[stroke].name.find("stroke") == 0);
    optimality.multipliers[clearance] = 2e3;
    optimality.multipliers[stroke] = -1e3;
    const std::string told = outcome_text(design, outcome, Console({}), {"out"});
    CAPTURE(told);
    CHECK(told.find(": with a lower limit that is 0.01 mm lower, the objective could be lower by 0.02") != std::string::npos);
    CHECK(told.find(": with an upper limit that is 0.01 mm higher, the objective could be lower by 0.01") != std::string::npos);
    description::Bounds& exact = design.constraints[stroke].bounds;
    exact.lower = exact.upper;
    CHECK(outcome_text(design, outcome, Console({}), {"out"}).find("with 0.01 mm more required") != std::string::npos);
}

TEST_CASE("a folder in which another program's report lies is left alone") {
    const DesignFolder folder;
    const std::string scene = folder.file("small.scene.json"), theirs = "<html>my own page</html>";
    for (const std::string& command : {"simulate " + scene + " --steps 1", "clearance " + scene, "optimise " + folder.design()}) {
        folder.write("out/report.html", theirs);
        refused(command + " --out " + folder.file("out"), {"report.html: is there and was not written by fettle"});
        CHECK(contents(folder.file("out/report.html")) == theirs);
    }
    std::filesystem::remove(folder.file("out/report.html"));
    CHECK(run("simulate " + scene + " --steps 1 --out " + folder.file("out")).code == 0);
    CHECK(run("simulate " + scene + " --steps 1 --out " + folder.file("out")).code == 0);  // its own it replaces
    for (const char* name : {"trajectory.json", "trajectory.start.json", "trajectory.running.json", "steps.csv", "contacts.csv",
                             "drives.csv", "joints.csv", "motion.glb"}) {
        const TemporaryFolder other;
        const std::string file = other.write(name, "time,mine\n1,2\n");
        refused("simulate " + scene + " --steps 1 --out " + other.path.string(), {file + ": is there and was not written by fettle"});
        CHECK(std::filesystem::file_size(file) == 14);
    }
    folder.write("tuned/design.final.json", R"({"my": "design"})");
    refused("optimise " + folder.design() + " --out " + folder.file("tuned"),
            {"design.final.json: is there and was not written by fettle"});
    folder.write("c.trajectory.json", "{}");
    refused("clearance " + scene + " --certificate " + folder.file("c.certificate.json"),
            {"c.trajectory.json: is there and was not written"});
    CHECK_FALSE(std::filesystem::exists(folder.file("c.certificate.json")));
    folder.write("out/report.html", theirs);
    refused("report " + folder.file("out"), {"report.html: is there and was not written by fettle"});
    CHECK(run("report " + folder.file("out") + " --out " + folder.file("out/report.html")).code == 0);  // it was named
    const std::string sweep = folder.write("sweep.jsonl", R"({"fettle_explore": 1, "design": "x", "parameters": ["height"]}
{"key": "0", "kind": "evaluate", "seed": 0, "status": "failed", "reason": "no shape"}
)");
    CHECK(run("report " + sweep).code == 0);
    CHECK(run("report " + sweep).code == 0);
    const std::string header = "{\"fettle_explore\": 1, \"design\": \"x\", \"parameters\": [\"height\"]}\n",
                      line = "{\"key\": \"0\", \"kind\": \"evaluate\", \"seed\": 0, \"status\": \"failed\", \"reason\": \"no shape\"}\n";
    const Answer torn = run("report " + folder.write("torn.jsonl", header + "garbage\n" + line), true);
    CHECK(torn.code == 0);
    CHECK(torn.says("no results were left out: 1"));
    const Answer cut =
        run("report " + folder.write("cut.jsonl", header + line + "{\"key\": \"1\", \"ki"), true);  // of a run that was killed
    CHECK(cut.code == 0);
    CHECK(cut.says("cut off"));
    folder.write("sweep.report.html", theirs);
    refused("report " + sweep, {"sweep.report.html: is there and was not written by fettle"});
    folder.write("out/result.json", R"({"my": "numbers"})");
    refused("clearance " + scene + " --out " + folder.file("out"), {"result.json: is there and was not written by fettle"});
}

}  // namespace fettle::design::cli::messages_test
