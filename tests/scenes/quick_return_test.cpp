// SPDX-License-Identifier: MIT
// A slotted-crank quick return in quasi-statics, which a force on its ram loads: a plain pin in a slot, and a linkage of which three
// conditions follow from the others. Each step is solved to rounding, however far apart the stiffness of the contact and the proximal term
// are.
#include "tests/scenes/part_mechanism.hpp"

namespace fettle::tests::scenes::quick_return_test {

using namespace part_mechanism;

namespace {

// @param times, forces  of the load on the ram [s], [N]
std::string quick_return(const char* times, const char* forces) {
    return formatted(R"json({
      "fettle_scene": 1, "units": "mm", "timestep": 0.004, "end_time": 0.2, "integrator": "quasi_static", "contact": {"dhat": 0.05},
      "bodies": [
        {"name": "crank", "density": 1240, "rotation": [0, 0, 90], "shape": {
          "profiles": {"disc": {"circle": 23}, "pin": {"circle": 3, "centre": [18, 0]}},
          "solid": {"stack": [{"layer": "disc", "height": 4}, {"layer": "pin", "height": 8}], "from": -5}, "counts": {"segments": 64}}},
        {"name": "lever", "density": 1240, "position": [0, -54, 0], "rotation": [0, 0, 90], "shape": {
          "profiles": {"lever": {"holes": [{"slot": [[35, 0], [73, 0]], "radius": 3.3}, {"circle": 2.5}, {"circle": 2.5, "centre": [90, 0]}],
                                 "in": {"slot": [[0, 0], [90, 0]], "radius": 7.3}}},
          "solid": {"extrude": "lever", "to": 6}, "counts": {"segments": 64}}},
        {"name": "link", "density": 1240, "position": [0, 36, 8], "group": "upper",
         "rotation_vector": [0, 0, "= atan2(-10mm, sqrt(3500mm^2))"], "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 4, "size_z": 4}}},
        {"name": "ram", "density": 1240, "position": ["= sqrt(3500mm^2) + 15mm", 26, 15], "group": "upper",
         "shape": {"part": "box", "dimensions": {"size_x": 50, "size_y": 12, "size_z": 4}}}],
      "joints": [
        {"name": "shaft", "type": "revolute", "b": "crank", "point": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "pivot", "type": "revolute", "b": "lever", "point_a": [0, -54, 0], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "eye", "type": "revolute", "a": "lever", "b": "link", "point_a": [90, 0, 8], "point_b": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "wrist", "type": "revolute", "a": "link", "b": "ram", "point_a": [60, 0, 0], "point_b": [-15, 0, -7], "axis": [0, 0, 1]},
        {"name": "guide", "type": "prismatic", "b": "ram", "point_b": [0, 0, 0], "axis": [1, 0, 0], "friction": 2}],
      "motors": [
        {"name": "drive", "joint": "shaft", "angle": {"rate": 360}},
        {"name": "cut", "joint": "guide", "force": {"times": %s, "values": %s}}]})json",
                     times, forces);
}

}  // namespace

TEST_CASE("a pin in a slot carries a load through a linkage in quasi-statics") {
    for (const auto& [times, forces] : {std::pair{"[0, 0.305, 0.315]", "[50, 50, 0]"}, {"[0.02, 0.06, 0.27]", "[0, 50, 50]"}}) {
        const Run run = part_mechanism::run(quick_return(times, forces));
        INFO(times << ": " << run.simulation.report.message);
        REQUIRE(run.simulation.report.status == core::stepper::SimulationStatus::ok);
        CHECK(run.steps() == 50);
        for (const core::stepper::StepReport& step : run.simulation.report.steps) CHECK(step.residual <= 1e-8);
    }
}

}  // namespace fettle::tests::scenes::quick_return_test
