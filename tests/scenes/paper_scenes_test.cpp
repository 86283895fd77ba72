// SPDX-License-Identifier: MIT
// Scenes of the source paper, loaded as they are: 50 steps each, and CGAL's exact predicates find no intersection at any stored node nor at
// 8 instants between each two. Needs ../shared; skipped without it.
#include <catch2/catch.hpp>

#include "fettle/core/model/build_model.hpp"
#include "fettle/core/scene/scene_reader.hpp"
#include "fettle/core/stepper/simulate.hpp"
#include "fettle/tests/support/intersection_oracle.hpp"
#include "fettle/tests/support/shared_files.hpp"

using namespace fettle;
using namespace fettle::core;
using namespace fettle::tests::support;

namespace {

void run_scene(const std::string& name) {
    INFO(name);
    const auto scene = scene::read_scene(shared_file("scenes/fixtures/" + name + ".json"));
    REQUIRE(scene.has_value());
    const auto model = model::build_model(*scene);
    REQUIRE(model.has_value());
    stepper::SimulationOptions options;
    options.steps = 50;
    const stepper::Simulation simulation = stepper::simulate(*model, options);
    INFO(simulation.report.message);
    REQUIRE(simulation.report.status == stepper::SimulationStatus::ok);
    REQUIRE(simulation.trajectory.steps.size() == 50);
    for (const auto& poses : simulation.trajectory.poses)
        for (const kinematics::Pose& pose : poses) {
            REQUIRE(pose.position.allFinite());
            REQUIRE((pose.rotation.transpose() * pose.rotation - Matrix3::Identity()).norm() < 1e-13);
        }
    const IntersectionReport report = find_intersections(*model, simulation.trajectory, 8);
    CHECK(report.instants >= 50 * 9);
    for (const Intersection& i : report.intersections) FAIL_CHECK(to_string(i, *model));
}

}  // namespace

TEST_CASE("5-cubes runs without intersection", "[paper]") {
    FETTLE_NEEDS_SHARED();
    run_scene("unit-tests/5-cubes");
}

TEST_CASE("tet-corner runs without intersection", "[paper]") {
    FETTLE_NEEDS_SHARED();
    run_scene("unit-tests/tet-corner");
}

TEST_CASE("bolt runs without intersection", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    run_scene("mechanisms/bolt");
}

TEST_CASE("piston runs without intersection", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    run_scene("mechanisms/507-movements/092-piston");
}

TEST_CASE("punching press runs without intersection", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    run_scene("mechanisms/507-movements/140-punching-press");
}

TEST_CASE("pendulum runs without intersection", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    run_scene("pendulum/pendulum");
}
