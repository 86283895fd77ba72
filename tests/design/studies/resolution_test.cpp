// SPDX-License-Identifier: MIT
#include "design/studies/resolution.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/problem/design_problem.hpp"
#include "design/studies/optimise_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::studies::resolution_test {

namespace {

using fettle::tests::support::replaced;

// A round post that falls freely, beside a block of a mesh that the scene writes itself.
const char* const scene = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.01, "end_time": 0.2,
    "bodies": [
      {"name": "post", "density": 1000, "shape": {"part": "cylinder", "dimensions": {"radius": 5, "length": 10}, "counts": {"segments": 24}}},
      {"name": "block", "type": "static", "position": [20, 0, 0],
       "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]}]})";
const char* const design = R"({"fettle_design": 1, "scene": "post.scene.json", "units": "mm",
    "parameters": [{"name": "length", "value": 10, "lower": 5, "upper": 20}], "set": {"/bodies/post/shape/dimensions/length": "= length"},
    "objective": [{"type": "mass", "bodies": ["post"]}],
    "constraints": [{"type": "stroke", "body": "post", "axis": [0, 0, 1], "upper": 500}]SCENARIOS})";

struct Folder : tests::support::TemporaryFolder {
    explicit Folder(const std::string& scenarios = "") {
        write("post.scene.json", scene);
        std::string text = design;
        write("post.design.json", text.replace(text.find("SCENARIOS"), 9, scenarios));
    }
    std::string path() const { return file("post.design.json"); }
};

}  // namespace

TEST_CASE("resolution: facets change what they make, and the time step what falls, as their closed forms say") {
    const Folder folder;
    const auto report = check_resolution(folder.path(), {});
    REQUIRE(report);
    CHECK(report->is_complete());
    CHECK_FALSE(report->friction_lags);
    CHECK(report->runs.size() == 4);
    CHECK(report->fixed_meshes == std::vector<std::string>{"block"});
    REQUIRE(report->quantities.size() == 2);
    // A polygon round a circle: area n r^2 tan(pi / n).
    const ResolvedQuantity& mass = report->quantities[0];
    const auto about = [](int n) { return n * std::tan(std::numbers::pi / n); };
    CHECK(mass.of_objective);
    CHECK(mass.as_written == Approx(about(24) * 25e-6 * 10e-3 * 1000));
    CHECK(mass.finer_facets == Approx(about(48) * 25e-6 * 10e-3 * 1000));
    CHECK(mass.finer_steps == mass.as_written);
    CHECK(mass.finer_both == mass.finer_facets);
    CHECK(mass.change() == Approx(1 - about(48) / about(24)));
    // Implicit Euler falls g h^2 n (n + 1) / 2 in n steps.
    const ResolvedQuantity& fall = report->quantities[1];
    CHECK(fall.as_written == Approx(9.81 * 0.2 * 0.21 / 2).epsilon(1e-6));
    CHECK(fall.finer_facets == Approx(fall.as_written).epsilon(1e-6));
    CHECK(fall.finer_steps == Approx(9.81 * 0.2 * 0.205 / 2).epsilon(1e-6));
    CHECK(fall.finer_both == Approx(fall.finer_steps).epsilon(1e-6));
}

TEST_CASE("resolution: scenarios are refined too, and contact is that of the design as written") {
    const Folder folder(R"(, "scenarios": [{"name": "a"}, {"name": "b", "set": {"/timestep": 0.02}}])");
    const auto report = check_resolution(folder.path(), {});
    REQUIRE(report);
    REQUIRE(report->quantities.size() == 3);
    CHECK(report->quantities[2].name == "stroke post [b]");
    CHECK(report->quantities[2].as_written == Approx(9.81 * 0.2 * 0.22 / 2).epsilon(1e-6));
    CHECK(report->quantities[2].finer_both == Approx(9.81 * 0.2 * 0.21 / 2).epsilon(1e-6));
}

TEST_CASE("resolution: a run that fails is named, and the others have their numbers") {
    const Folder folder;
    ResolutionOptions options;
    int runs = 0;
    options.on_variant = [&](const std::string&) {
        if (++runs == 4) folder.write("post.scene.json", "{}");
    };
    const auto report = check_resolution(folder.path(), {}, options);
    REQUIRE(report);
    CHECK_FALSE(report->is_complete());
    CHECK_FALSE(report->interrupted);
    REQUIRE(report->runs.size() == 4);
    CHECK(report->runs[3].name == "with both");
    CHECK_FALSE(report->runs[3].failure.empty());
    for (int k = 0; k < 3; ++k) CHECK(report->runs[k].failure.empty());
    for (const ResolvedQuantity& quantity : report->quantities) {
        CHECK(std::isfinite(quantity.as_written));
        CHECK(std::isfinite(quantity.finer_facets));
        CHECK(std::isfinite(quantity.finer_steps));
        CHECK(std::isnan(quantity.finer_both));
        CHECK(std::isnan(quantity.change()));
    }
}

TEST_CASE("resolution: what is interrupted says where, and a design that cannot be read is an error") {
    const Folder folder;
    ResolutionOptions options;
    int asked = 0;
    options.should_stop = [&] { return ++asked > 3; };
    const auto stopped = check_resolution(folder.path(), {}, options);
    REQUIRE(stopped);
    CHECK(stopped->interrupted);
    REQUIRE(stopped->runs.size() == 4);
    CHECK(stopped->runs[0].failure != "not begun");
    CHECK(stopped->runs[1].failure == "not begun");
    CHECK_FALSE(stopped->is_complete());
    CHECK_FALSE(check_resolution(folder.file("none.design.json"), {}));
}

TEST_CASE("resolution: friction that lags is settled too") {
    // A block that is thrown onto a floor slides: its normal force changes from step to step.
    const char* const scene = R"({"fettle_scene": 1, "units": "mm", "gravity": [0, 0, -9.81], "timestep": 0.005, "end_time": 0.1,
        "integrator": "implicit_euler", "friction": {"mu": MU, "rounds": ROUNDS},
        "bodies": [
          {"name": "floor", "type": "static", "position": [0, 0, -5],
           "shape": {"part": "box", "dimensions": {"size_x": 200, "size_y": 50, "size_z": 10}}},
          {"name": "block", "density": 1000, "linear_velocity": [500, 0, -200], "position": [0, 0, 7],
           "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}]})";
    const char* const design = R"({"fettle_design": 1, "scene": "post.scene.json", "units": "mm",
        "parameters": [{"name": "size", "value": 10, "lower": 5, "upper": 20}],
        "set": {"/bodies/block/shape/dimensions/size_y": "= size"},
        "objective": [{"type": "stroke", "body": "block", "axis": [1, 0, 0]}]})";
    const auto of = [&](const std::string& mu, const std::string& rounds) {
        Folder folder;
        std::string text = scene;
        text.replace(text.find("MU"), 2, mu).replace(text.find("ROUNDS"), 6, rounds);
        folder.write("post.scene.json", text);
        folder.write("post.design.json", design);
        return check_resolution(folder.path(), {});
    };
    const auto lagging = of("0.3", "1"), settled = of("0.3", "\"converged\""), without = of("0", "1");
    REQUIRE(lagging);
    REQUIRE(settled);
    REQUIRE(without);
    CHECK(lagging->is_complete());
    CHECK(lagging->friction_lags);
    REQUIRE(lagging->runs.size() == 5);
    CHECK(lagging->runs[4].name == "with settled friction");
    CHECK(lagging->quantities[0].change_by_friction() > 1e-3);
    CHECK(lagging->quantities[0].settled_friction == settled->quantities[0].as_written);
    CHECK_FALSE(settled->friction_lags);
    CHECK(settled->runs.size() == 4);
    CHECK_FALSE(without->friction_lags);
}

TEST_CASE("resolution: a design that was found is measured once more, finer, where it was found") {
    const Folder folder;
    const auto file = reading::read_design(folder.path());
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    const VectorX point = VectorX::Constant(1, 8e-3);  // not the file's length
    const problem::DesignEvaluation found = problem->evaluate(point, {.gradients = false});
    REQUIRE(found.usable);
    const FinerReport report = measure_finer(*file, *problem, point, {});
    REQUIRE(report.runs.size() == 2);
    CHECK_FALSE(report.interrupted);
    const auto about = [](int n) { return n * std::tan(std::numbers::pi / n); };
    const FinerRun &facets = report.runs[0], &steps = report.runs[1];
    CHECK(facets.key == "finer_facets");
    CHECK(facets.terms[0].value == Approx(about(48) * 25e-6 * 8e-3 * 1000));
    CHECK(facets.objective / found.objective == Approx(about(48) / about(24)));
    CHECK(steps.key == "finer_steps");
    CHECK(steps.constraints[0].value == Approx(9.81 * 0.2 * 0.205 / 2).epsilon(1e-6));

    // The fall is allowed 0.204 m: 0.206 as written, so what the other step changes decides.
    description::Design design = problem->design();
    design.constraints[0].bounds.upper = 0.203;
    const auto values = finer_values(design, found, report);
    REQUIRE(values.size() == 2);
    CHECK(values[0].of_objective);
    CHECK(values[0].run == &facets);
    CHECK(values[0].share == Approx(1 - about(48) / about(24)));
    CHECK(values[1].run == &steps);
    CHECK_FALSE(values[1].is_met);
    design.constraints[0].bounds.lower = 0.205;
    design.constraints[0].bounds.upper = 1;
    const auto flipped = finer_values(design, found, report);
    CHECK(flipped[1].is_met);
    CHECK_FALSE(flipped[1].is_met_finer);
    CHECK(flipped[1].run == &steps);

    // A lower bound that holds and costs 2 per metre is met by less: the best would be that much dearer.
    const double fallen = steps.constraints[0].lower - found.constraints[0].lower;
    CHECK(fallen < 0);
    CHECK(change_of_best(found, VectorX::Constant(1, 2), steps) == Approx(-2 * fallen));
    CHECK(change_of_best(found, {}, facets) == Approx(facets.objective - found.objective));
}

TEST_CASE("resolution: parts without anything round are not simulated with more facets; a stop is told") {
    const Folder folder;
    folder.write("post.scene.json",
                 replaced(replaced(replaced(scene, "\"cylinder\"", "\"box\""), "\"radius\": 5, \"length\": 10", "\"size_x\": 10"),
                          ", \"counts\": {\"segments\": 24}", ""));
    folder.write("post.design.json", replaced(replaced(design, "SCENARIOS", ""), "dimensions/length", "dimensions/size_z"));
    const auto file = reading::read_design(folder.path());
    REQUIRE(file);
    const auto problem = problem::DesignProblem::create(file->design);
    REQUIRE(problem);
    const VectorX point = description::values_of(file->design.parameters);
    const FinerReport report = measure_finer(*file, *problem, point, {});
    REQUIRE(report.runs.size() == 1);
    CHECK(report.runs[0].key == "finer_steps");
    ResolutionOptions stopped;
    stopped.should_stop = [] { return true; };
    const FinerReport none = measure_finer(*file, *problem, point, {}, stopped);
    CHECK(none.interrupted);
    CHECK(finer_values(file->design, problem->evaluate(point), none).empty());
    CHECK(std::isnan(change_of_best(problem->evaluate(point), {}, none.runs[0])));
}

}  // namespace fettle::design::studies::resolution_test
