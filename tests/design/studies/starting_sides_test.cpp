// SPDX-License-Identifier: MIT
#include "design/studies/starting_sides.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "design/reading/design_text.hpp"
#include "design/studies/random_start.hpp"
#include "tests/design/small_problem.hpp"
#include "tests/support/program.hpp"
#include "tests/support/text.hpp"

namespace fettle::design::studies::starting_sides_test {

namespace {

using core::scene::AssembleSide;
using fettle::tests::support::contents;
using fettle::tests::support::run;
using namespace fettle::tests::design_support;

// Crank 20 mm, coupler 50 mm, rocker 40 mm, pivots 45 mm apart, all bars written about one place; B joins coupler and rocker.
const char* const four_bar = R"({
  "fettle_scene": 1, "units": "mm", "timestep": 0.02, "end_time": 0.2,
  "bodies": [
    {"name": "crank", "group": 1, "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 4, "size_z": 3}}},
    {"name": "coupler", "group": 1, "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 50, "size_y": 4, "size_z": 3}},
     "rotation": [0, 0, 30]},
    {"name": "rocker", "group": 1, "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 40, "size_y": 4, "size_z": 3}},
     "rotation": [0, 0, 90]}
  ],
  "joints": [
    {"name": "O", "type": "revolute", "b": "crank", "point_a": [0, 0, 0], "point_b": [-10, 0, 0], "axis": [0, 0, 1]},
    {"name": "A", "type": "revolute", "a": "crank", "b": "coupler", "point_a": [10, 0, 0], "point_b": [-25, 0, 0], "axis": [0, 0, 1]},
    {"name": "B", "type": "revolute", "a": "coupler", "b": "rocker", "point_a": [25, 0, 0], "point_b": [20, 0, 0], "axis": [0, 0, 1]},
    {"name": "C", "type": "revolute", "b": "rocker", "point_a": [45, 0, 0], "point_b": [-20, 0, 0], "axis": [0, 0, 1]}
  ],
  "motors": [{"name": "drive", "joint": "O", "angle": {"times": [0, 0.2], "values": [0, 90]}}]
})";

const char* const swing = R"({
  "fettle_design": 1, "scene": "small.scene.json", "units": "mm",
  "parameters": [{"name": "coupler_length", "value": 50, "lower": 45, "upper": 60}],
  "set": {"/joints/A/point_b/0": "= -coupler_length / 2", "/joints/B/point_a/0": "= coupler_length / 2"},
  "objective": [{"type": "turn", "body": "rocker", "axis": [0, 0, 1], "over": "peak"}],
  "optimiser": {"max_evaluations": 10}
})";

std::string with_side(const std::string& scene, const std::string& said) {
    return replaced(scene, R"("point_b": [20, 0, 0], "axis": [0, 0, 1])", R"("point_b": [20, 0, 0], "axis": [0, 0, 1], )" + said);
}

double swing_of(const problem::DesignProblem& problem) {
    problem::EvaluateOptions values;
    values.gradients = false;
    const problem::DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters), values);
    REQUIRE(at.usable);
    return at.terms.at(0).value * 180 / 3.14159265358979323846;
}

}  // namespace

TEST_CASE("the side that the written poses decide is found, and seeds take both", "[branch]") {
    const DesignFolder folder(swing, four_bar);
    const problem::DesignProblem problem = problem_of(folder);
    const Sides written = sides_of(problem);
    REQUIRE(written.size() == 1);
    CHECK(written[0].joint == "B");
    CHECK(written[0].assemble.from == "A");
    CHECK(written[0].assemble.to == "C");
    const AssembleSide side = written[0].assemble.side, other = core::model::other_side(side);
    CHECK(sides_of_seed(problem, 0)[0].assemble.side == side);
    CHECK(sides_of_seed(problem, 1001)[0].assemble.side == other);
    CHECK(sides_of_seed(problem, 1002)[0].assemble.side == side);
    const auto same = problem_of_seed(problem, 0), turned = problem_of_seed(problem, 1001);
    REQUIRE(same);
    REQUIRE(turned);
    CHECK(swing_of(*same) == swing_of(problem));  // bit for bit
    // In closed form the rocker swings by 54.6 degrees with the bend to the left, by 12.8 with that to the right.
    const auto expected = [](AssembleSide at) { return at == AssembleSide::left ? 54.63 : 12.8; };
    CHECK(std::abs(swing_of(*same)) == Approx(expected(side)).margin(0.05));
    CHECK(std::abs(swing_of(*turned)) == Approx(expected(other)).margin(0.05));
    CHECK(sides_of(*turned)[0].assemble.side == other);
}

TEST_CASE("a side that is said is tried from both ends, too, unless the design keeps its sides", "[branch]") {
    const DesignFolder folder(swing, with_side(four_bar, R"("assemble": {"side": "left"})"));
    description::Design design = file_of(folder).design;
    const auto problem = problem::DesignProblem::create(design);
    REQUIRE(problem);
    CHECK(sides_of_seed(*problem, 7)[0].assemble.side == AssembleSide::right);
    design.optimiser.keep_sides = true;
    const auto keeping = problem::DesignProblem::create(design);
    REQUIRE(keeping);
    CHECK(sides_of_seed(*keeping, 7)[0].assemble.side == AssembleSide::left);
}

TEST_CASE("the text of a design on a side reads back as that design", "[branch]") {
    for (const bool is_said : {false, true}) {
        const DesignFolder folder(
            replaced(swing, R"("set": {)", is_said ? R"("set": {"/joints/2/assemble/side": "left", )" : R"("set": {)"),
            is_said ? with_side(four_bar, R"("assemble": {"side": "right"})") : four_bar);
        const reading::DesignFile file = file_of(folder);
        const problem::DesignProblem problem = problem_of(folder);
        for (const std::uint64_t seed : {0, 1001}) {
            const Result<FileOfSeed> begun = file_of_seed(file, problem, seed);
            REQUIRE(begun);
            const auto again = reading::parse_design(begun->file.text, file.path);
            REQUIRE(again);
            const auto read = problem::DesignProblem::create(again->design);
            REQUIRE(read);
            CHECK(swing_of(*read) == swing_of(begun->problem));
            CHECK(reading::design_hash(begun->file) == reading::design_hash(*again));
        }
    }
}

TEST_CASE("--starts takes the sides in turn, and says which", "[branch]") {
    const DesignFolder folder(swing, four_bar);
    const std::filesystem::path out = folder.path / "out";
    const std::string command = "optimise " + folder.design() + " --starts 3 --no-report --json --out " + out.string();
    const nlohmann::json answer = run(command).json();
    const nlohmann::json& rows = answer.at("starts");
    const std::string first = rows.at(0).at("sides").at("B");
    CHECK(rows.at(1).at("sides").at("B") != first);
    CHECK(rows.at(2).at("sides").at("B") == first);
    for (const nlohmann::json& row : rows)
        if (row.at("seed") == answer.at("seed")) CHECK(answer.at("sides") == row.at("sides"));
    const nlohmann::json final = nlohmann::json::parse(contents(out / "design.final.json"));
    CHECK(final.at("set").at("/joints/B/assemble").at("side") == answer["sides"]["B"]);
    CHECK(run("gradient " + (out / "design.final.json").string() + " --json").json().at("objective") == answer.at("objective"));
    const nlohmann::json resumed = run(command + " --resume").json();
    CHECK(resumed.at("parameters") == answer.at("parameters"));
    CHECK(resumed.at("sides") == answer.at("sides"));
}

}  // namespace fettle::design::studies::starting_sides_test
