// SPDX-License-Identifier: MIT
// Every scene of the source paper that we have, as it is: to its own end or, where that is long, at least 200 steps. No NaN, no stall
// (CTest's time limit), and no intersection by exact predicates at any node nor at instants between each two. Needs ../shared; skipped
// without it.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/intersection_oracle.hpp"
#include "tests/support/shared_files.hpp"

namespace fettle::tests::scenes::fixtures_test {

using namespace fettle::core;
using namespace fettle::tests::support;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t quick_size = 100;  // vertices: such a scene runs in the fast tests

std::vector<std::string> fixtures() {
    std::vector<std::string> names;
    for (const auto& file : fs::recursive_directory_iterator(shared_folder() / "scenes/fixtures"))
        if (file.path().extension() == ".json") names.push_back(file.path().string());
    std::sort(names.begin(), names.end());
    return names;
}

model::Model model_of(const std::string& path) {
    const auto scene = scene_files::read_scene(path);
    for (const auto& error : scene.errors()) FAIL(error.where << ": " << error.message);
    auto model = setup::build_model(*scene);
    for (const auto& error : model.errors()) FAIL(error.where << ": " << error.message);
    return std::move(*model);
}

std::size_t vertex_count(const model::Model& model) {
    std::size_t count = 0;
    for (const model::Body& body : model.bodies) count += static_cast<std::size_t>(body.mesh.vertices.cols());
    return count;
}

/// Steps to run at least: the whole of a scene that is small, 200 of one that is not.
int steps_of(const model::Model& model, int at_most) {
    const int own = stepper::step_count(model, {});
    return std::min(own, at_most);
}

void run_scene(const std::string& path, const model::Model& model, int steps, int instants_between) {
    INFO(path);
    stepper::SimulationOptions options;
    options.steps = steps;
    const stepper::Simulation simulation = stepper::simulate(model, options);
    const int done = count_of(simulation.trajectory.steps);
    INFO("step " << done << " of " << steps << ": " << to_string(simulation.report.status) << " " << simulation.report.message);
    CHECK(simulation.report.status == stepper::SimulationStatus::ok);
    bool finite = true;
    for (const auto& poses : simulation.trajectory.poses)
        for (const kinematics::Pose& pose : poses) {
            finite &= pose.position.allFinite();
            finite &= (pose.rotation.transpose() * pose.rotation - Matrix3::Identity()).norm() < 1e-13;
        }
    CHECK(finite);
    for (const stepper::StepReport& step : simulation.report.steps) finite &= step.minimum_distance > model.dmin;
    CHECK(finite);
    const IntersectionReport report = find_intersections(model, simulation.trajectory, instants_between);
    CHECK(report.instants >= static_cast<long>(done) * (instants_between + 1));
    for (const Intersection& i : report.intersections) FAIL_CHECK(to_string(i, model));
}

}  // namespace

TEST_CASE("small scenes of the paper run without intersection", "[paper]") {
    FETTLE_NEEDS_SHARED();
    int small = 0;
    for (const std::string& path : fixtures()) {
        const model::Model model = model_of(path);
        if (vertex_count(model) > quick_size) continue;
        ++small;
        run_scene(path, model, steps_of(model, 60), 3);
    }
    CHECK(small > 15);
}

TEST_CASE("every scene of the paper runs to its end, or long, without intersection", "[paper][slow]") {
    FETTLE_NEEDS_SHARED();
    const std::vector<std::string> paths = fixtures();
    CHECK(paths.size() >= 46);
    for (const std::string& path : paths) {
        const model::Model model = model_of(path);
        run_scene(path, model, steps_of(model, vertex_count(model) > 2000 ? 200 : 1000), 7);
    }
}

}  // namespace fettle::tests::scenes::fixtures_test
