// SPDX-License-Identifier: MIT
#include "design/problem/fits.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "design/problem/smoother_models.hpp"
#include "design/reading/scene_shapes.hpp"
#include "design/studies/optimise_design.hpp"
#include "tests/design/small_problem.hpp"

namespace fettle::design::problem::fits_test {

namespace {

using namespace fettle::tests::design_support;

core::model::Model model_of(const std::string& bodies_and_joints) {
    const fettle::tests::support::TemporaryFolder folder;
    const std::string text = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.005, "end_time": 0.05, "contact": {"dhat": 0.05},
        )" + bodies_and_joints +
                             "}";
    const auto scene = core::scene_files::read_scene(folder.write("a.scene.json", text), reading::scene_read_options());
    REQUIRE(scene);
    auto model = core::setup::build_model(*scene);
    REQUIRE(model);
    return std::move(model).value();
}

std::string box(const std::string& name, const std::string& more, double x, double y, double z) {
    return R"({"name": ")" + name + R"(", )" + more + R"("shape": {"part": "box", "dimensions": {"size_x": )" + std::to_string(x) +
           R"(, "size_y": )" + std::to_string(y) + R"(, "size_z": )" + std::to_string(z) + "}}}";
}

const std::string pin = R"({"name": "pin", "density": 1000, MORE "shape": {"part": "cylinder",
    "dimensions": {"radius": 4, "length": 10}, "counts": {"segments": 48}}})";
const std::string ring = R"({"name": "ring", "type": "static", "shape": {"profiles": {"ring": {"holes": [{"circle": 4.3, "name": "bore"}],
    "in": {"circle": 8, "name": "rim"}}}, "solid": {"extrude": "ring", "to": 6}, "counts": {"segments": 48}}})";

std::string pin_with(const std::string& more) { return replaced(pin, "MORE", more); }

}  // namespace

TEST_CASE("a pin in a bore is a fit wherever it lies in it; on an ideal joint, or held, it is none") {
    for (const std::string place : {"0, 0, 3", "0.2, 0.1, 3"}) {
        CAPTURE(place);
        const Fits fits = fits_of(model_of(R"("bodies": [)" + ring + ", " + pin_with(R"("position": [)" + place + "],") + "]"));
        REQUIRE(fits.fits.size() == 1);
        CHECK(fits.fits[0].a == 0);
        CHECK(fits.fits[0].b == 1);
        CHECK(fits.fits[0].play == Approx(0.3e-3).epsilon(0.07));  // less what the facets' covers take
        CHECK(fits.play() == fits.fits[0].play);
    }
    const std::string joint = R"(, "joints": [{"name": "j", "type": "revolute", "a": "ring", "b": "pin", "point": [0, 0, 3],
        "axis": [0, 0, 1], "collide": true}])";
    const Fits jointed = fits_of(model_of(R"("bodies": [)" + ring + ", " + pin_with(R"("position": [0, 0, 3],)") + "]" + joint));
    CHECK(jointed.fits.empty());
    CHECK(jointed.play() == 0);
    CHECK(jointed.nearest_other == Approx(0.3e-3).epsilon(0.07));
    const std::string held = R"("position": [0, 0, 3], "fixed": ["px", "py", "rx", "ry"],)";
    CHECK(fits_of(model_of(R"("bodies": [)" + ring + ", " + pin_with(held) + "]")).fits.empty());
}

TEST_CASE("what contact keeps from one side is no fit, from both sides it is one") {
    const std::string table = box("table", R"("type": "static", "position": [0, 0, -5.02], )", 60, 60, 10);
    const std::string block = box("block", R"("density": 1000, "position": [0, 0, 5.1], )", 10, 10, 10);
    CHECK(fits_of(model_of(R"("bodies": [)" + table + ", " + block + "]")).fits.empty());
    // Between two plates that cannot move, 0.12 and 0.3 mm away.
    const std::string lid = box("lid", R"("type": "static", "position": [0, 0, 15.4], )", 60, 60, 10);
    const Fits between = fits_of(model_of(R"("bodies": [)" + table + ", " + block + ", " + lid + "]"));
    REQUIRE(between.fits.size() == 2);
    for (const Fit& fit : between.fits) CHECK(fit.play == Approx(0.21e-3).epsilon(1e-6));
    CHECK(std::isinf(between.nearest_other));
    // A follower on a slide, which only the wall in front stops.
    const std::string wall = box("wall", R"("type": "static", "position": [10.2, 0, 5], )", 10, 20, 20);
    const std::string slide =
        R"(, "joints": [{"name": "slide", "type": "prismatic", "b": "block", "point": [0, 0, 0], "axis": [1, 0, 0]}])";
    const Fits follower = fits_of(model_of(R"("bodies": [)" + wall + ", " + block + "]" + slide));
    CHECK(follower.fits.empty());
    CHECK(follower.nearest_other == Approx(0.2e-3).epsilon(1e-6));
    const std::string behind = box("behind", R"("type": "static", "position": [-10.1, 0, 5], )", 10, 20, 20);
    const Fits kept = fits_of(model_of(R"("bodies": [)" + wall + ", " + block + ", " + behind + "]" + slide));
    REQUIRE(kept.fits.size() == 2);
    CHECK(kept.play() == Approx(0.15e-3).epsilon(1e-6));
}

TEST_CASE("a gap that no free motion changes is near, and no fit's") {
    // A tongue in a groove, 0.25 mm to either side, 0.1 mm from its bottom, which it cannot leave.
    const std::string groove = box("left", R"("type": "static", "position": [0, 8.25, 0], )", 40, 10, 10) + ", " +
                               box("right", R"("type": "static", "position": [0, -8.25, 0], )", 40, 10, 10) + ", " +
                               box("bottom", R"("type": "static", "position": [0, 0, -8.1], )", 40, 5, 6);
    const std::string tongue = box("tongue", R"("density": 1000, "fixed": ["pz", "rx", "ry"], )", 20, 6, 10);
    const Fits fits = fits_of(model_of(R"("bodies": [)" + groove + ", " + tongue + "]"));
    REQUIRE(fits.fits.size() == 2);
    CHECK(fits.play() == Approx(0.25e-3).epsilon(1e-6));
    CHECK(fits.nearest_other == Approx(0.1e-3).epsilon(1e-6));
}

TEST_CASE("bodies that touch from one side in the motion are named, those of fits and those that slide are not") {
    const std::string table = box("table", R"("type": "static", "position": [0, 0, -5], )", 60, 60, 10);
    const std::string block = box("block", R"("density": 1000, "position": [0, 0, 5.02], MORE )", 10, 10, 10);
    const auto touching = [&](const std::string& bodies) {
        const core::model::Model model = model_of(R"("gravity": [0, 0, -9.81], "bodies": [)" + bodies + "]");
        core::stepper::SimulationOptions options;
        options.steps = 3;
        return touching_without_fit(model, core::stepper::simulate(model, options).trajectory, fits_of(model));
    };
    const auto resting = touching(table + ", " + replaced(block, "MORE", ""));
    REQUIRE(resting);
    CHECK(resting->a == 0);
    CHECK(resting->b == 1);
    CHECK_FALSE(touching(table + ", " + replaced(block, "MORE", R"("fixed": ["pz", "rx", "ry"],)")));
    CHECK_FALSE(touching(ring + ", " + pin_with(R"("position": [0.2, 0.1, 3], "fixed": ["pz"],)")));
}

namespace {

// A block on a slide; `more` fits round it.
const char* const pushed_scene = R"({"fettle_scene": 1, "units": "mm", "timestep": 0.005, "end_time": 0.05, "gravity": GRAVITY,
    "contact": {"dhat": 0.04}, "variables": {"play": "0.3mm"},
    "bodies": [
      {"name": "ring", "type": "static", "shape": {"profiles": {"ring": {"holes": [{"circle": "= 4mm + play", "name": "bore"}],
        "in": {"circle": 8, "name": "rim"}}}, "solid": {"extrude": "ring", "to": 6}, "counts": {"segments": 48}}},
      {"name": "pin", "density": 1000, "position": [0, 0, 3], "fixed": ["pz", "rx", "ry"],
       "shape": {"part": "cylinder", "dimensions": {"radius": 4, "length": 10}, "counts": {"segments": 48}}}]JOINTS})";
const char* const pushed_design = R"({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
    "parameters": [{"name": "play", "value": 0.3, "lower": 0.1, "upper": 0.5}],
    "objective": [{"type": "stroke", "body": "pin", "axis": [1, 0, 0]}],
    "constraints": [
      {"type": "stroke", "body": "pin", "axis": [1, 0, 0], "lower": 0.1},
      {"type": "play", "a": "pin", "b": "ring", "lower": 0.1}]})";

DesignFolder pushed(const std::string& gravity, const std::string& joints) {
    return DesignFolder(pushed_design, replaced(replaced(pushed_scene, "GRAVITY", gravity), "JOINTS", joints));
}

}  // namespace

TEST_CASE("the play is taken up by contact of the design's own kind, as wide as the play is now") {
    const DesignFolder folder = pushed("[200, 0, 0]", "");
    const DesignProblem problem = problem_of(folder);
    for (const double play : {0.3e-3, 0.2e-3}) {
        CAPTURE(play);
        const DesignEvaluation at = problem.evaluate(VectorX::Constant(1, play), {.gradients = false});
        REQUIRE(at.usable);
        const PlayTakenUp compared = play_taken_up(problem, at);
        CAPTURE(compared.why_not);
        REQUIRE(compared.model);
        CHECK(compared.model->dhat == Approx(widest_share * play).epsilon(0.1));
        const auto wide = compared.model->problem.model_at(VectorX::Constant(1, play));
        REQUIRE(wide);
        CHECK(wide->round_reach > 0);  // round, as the design's own
        CHECK(wide->facet_sides.empty());
    }
    // What no motion changes is in no doubt, whatever the model says of it.
    const DesignEvaluation own = problem.evaluate(VectorX::Constant(1, 0.3e-3), {.gradients = false});
    DesignEvaluation other = own;
    for (description::Measurement& measured : other.constraints) measured = description::computed(0);
    REQUIRE(problem.design().constraints[1].quantity->is_at_rest());
    CHECK(studies::requirements_in_doubt(problem.design(), own, other) == std::vector<std::size_t>{0});
}

TEST_CASE("where loads go through ideal joints alone there is no play to take up, where a contact from one side carries one it is said") {
    const DesignProblem jointed = problem_of(pushed("[0, 0, 0]", R"(,
        "joints": [{"name": "j", "type": "revolute", "a": "ring", "b": "pin", "point": [0, 0, 3], "axis": [0, 0, 1], "collide": true}])"));
    const DesignEvaluation at = jointed.evaluate(VectorX::Constant(1, 0.3e-3), {.gradients = false});
    REQUIRE(at.usable);
    const PlayTakenUp none = play_taken_up(jointed, at);
    CHECK_FALSE(none.model);
    CHECK(none.why_not.empty());

    // A second block rests on the ring's upper face.
    const std::string resting = replaced(replaced(pushed_scene, "GRAVITY", "[0, 0, -9.81]"), "}]JOINTS", R"(},
      {"name": "weight", "density": 1000, "position": [0, 6, 8.52],
       "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 2, "size_z": 5}}}])");
    const DesignProblem loaded = problem_of(DesignFolder(pushed_design, resting));
    const DesignEvaluation rests = loaded.evaluate(VectorX::Constant(1, 0.3e-3), {.gradients = false});
    REQUIRE(rests.usable);
    const PlayTakenUp said = play_taken_up(loaded, rests);
    CHECK_FALSE(said.model);
    CHECK(said.why_not.find("`ring` and `weight` touch from one side") == 0);
}

}  // namespace fettle::design::problem::fits_test
