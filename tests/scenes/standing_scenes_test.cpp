// SPDX-License-Identifier: MIT
// What the paper builds with friction stands: scenes as they are, over 5 s. Needs ../shared; skipped without it.
#include <catch2/catch.hpp>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/shared_files.hpp"

namespace fettle::tests::scenes::standing_scenes_test {

using namespace fettle::core;
using namespace fettle::tests::support;

namespace {

struct Run {
    model::Model model;
    stepper::Simulation simulation;

    explicit Run(const std::string& name, double seconds) {
        const auto scene = scene_files::read_scene(shared_file("scenes/fixtures/friction/" + name + ".json"));
        REQUIRE(scene.has_value());
        auto built = setup::build_model(*scene);
        REQUIRE(built.has_value());
        model = std::move(*built);
        stepper::SimulationOptions options;
        options.steps = static_cast<int>(std::lround(seconds / model.timestep));
        simulation = stepper::simulate(model, options);
        INFO(name << ": " << simulation.report.message);
        REQUIRE(simulation.report.status == stepper::SimulationStatus::ok);
    }

    const std::vector<kinematics::Pose>& poses_at(double time) const {
        return simulation.trajectory.poses[std::lround(time / model.timestep)];
    }

    /// The furthest that any point of any body gets from where it was at `from`, seen at `to`.
    double moved(double from, double to) const {
        double furthest = 0;
        for (std::size_t i = 0; i < model.bodies.size(); ++i) {
            const Matrix3X& v = model.bodies[i].mesh.vertices;
            for (Eigen::Index k = 0; k < v.cols(); ++k)
                furthest =
                    std::max(furthest, (world_position(poses_at(from)[i], v.col(k)) - world_position(poses_at(to)[i], v.col(k))).norm());
        }
        return furthest;
    }
};

}  // namespace

TEST_CASE("the arch stands for 5 s", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const Run run("arch/arch-25-stones", 5);
    CHECK(run.moved(0, 5) < 0.05 * 62);  // it is 62 m high, and its stones start with gaps between them
    CHECK(run.moved(4, 5) < 2e-3);       // at rest, but for creep below the static speed bound
}

TEST_CASE("the card tent stands for 5 s", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const Run run("card-house/card-tent", 5);
    CHECK(run.moved(0, 5) < 0.1);
    CHECK(run.moved(4, 5) < 2e-3);
}

TEST_CASE("the two-level card house stands for 5 s", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const Run run("card-house/card-house-2-levels", 5);
    CHECK(run.moved(0, 1) < 0.3);   // its cards start in the air: the upper ones fall 0.24 m into place
    CHECK(run.moved(1, 5) < 8e-3);  // then creep below the static speed bound of 1 mm/s is left
}

TEST_CASE("the paper's block stays on its incline at mu 0.5", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const Run run("incline-plane/slopeTest_highSchoolPhysics_mu=0.5", 10);
    CHECK(run.moved(2, 10) < 8 * 1.01 * run.model.friction.eps_v);
}

TEST_CASE("the paper's block slides down its incline at mu 0.49", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const Run run("incline-plane/slopeTest_highSchoolPhysics_mu=0.49", 8);
    const double angle = 26.565 * std::acos(-1.0) / 180, expected = 9.8 * (std::sin(angle) - 0.49 * std::cos(angle));
    const Vector3 first = run.poses_at(5)[0].position - run.poses_at(2)[0].position;
    const Vector3 second = run.poses_at(8)[0].position - run.poses_at(5)[0].position;
    CHECK((second - first).norm() / 9 == Approx(expected).epsilon(0.01));
}

}  // namespace fettle::tests::scenes::standing_scenes_test
