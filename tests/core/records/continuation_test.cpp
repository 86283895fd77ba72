// SPDX-License-Identifier: MIT
// A simulation that is cut and taken up again ends with the same bits as one that was not, with every integrator, with friction and with a
// kappa that moves, in memory and through a file; what does not belong to the scene is refused.
#include "core/records/continuation.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "core/records/trajectory_io.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::core::records::continuation_test {

using namespace fettle::core::stepper;
using namespace fettle::tests::support;

namespace {

// A box that falls tilted on a plate, bounces and slides.
model::Model tumbling_box(scene::Integrator integrator) {
    model::Model model;
    model.bodies = {ground_plate(), make_body("box", box_mesh(Vector3(-0.2, -0.1, -0.05), Vector3(0.2, 0.1, 0.05)),
                                              make_pose(Vector3(0.4, 0.3, 0), Vector3(0, 0, 0.25)))};
    set_velocity(model.bodies[1], Vector3(1, 0.2, -1), Vector3(0, 3, 1));
    model.gravity = Vector3(0, 0, -9.81);
    model.dhat = 1e-3;
    model.diagonal = 4;
    model.velocity_tolerance = 1e-3;
    model.kappa = model::choose_kappa(model);
    model.adaptive_kappa = true;
    model.friction.mu = MatrixX::Constant(1, 1, 0.3);
    model.integrator = integrator;
    return model;
}

void check_same(const Simulation& a, const Simulation& b) {
    REQUIRE(a.trajectory.poses.size() == b.trajectory.poses.size());
    for (std::size_t t = 0; t < a.trajectory.poses.size(); ++t)
        for (std::size_t i = 0; i < a.trajectory.poses[t].size(); ++i) {
            REQUIRE(a.trajectory.poses[t][i].rotation == b.trajectory.poses[t][i].rotation);
            REQUIRE(a.trajectory.poses[t][i].position == b.trajectory.poses[t][i].position);
        }
    REQUIRE(a.trajectory.steps.size() == b.trajectory.steps.size());
    for (std::size_t t = 0; t < a.trajectory.steps.size(); ++t)
        REQUIRE(a.trajectory.steps[t].nodes.size() == b.trajectory.steps[t].nodes.size());
    CHECK(a.checkpoint.step == b.checkpoint.step);
    CHECK(a.checkpoint.state.kappa == b.checkpoint.state.kappa);
}

}  // namespace

TEST_CASE("a simulation taken up again ends as one run would", "[continuation]") {
    for (const scene::Integrator integrator : {scene::Integrator::implicit_euler, scene::Integrator::bdf2, scene::Integrator::newmark}) {
        model::Model model = tumbling_box(integrator);
        if (integrator == scene::Integrator::newmark) model.bodies[1].pose_start.position.z() += 10;  // it gains energy where parts meet
        SimulationOptions options;
        options.steps = 80;
        options.outputs = true;
        const Simulation whole = simulate(model, options);
        INFO(whole.report.message);
        REQUIRE(whole.report.status == SimulationStatus::ok);
        options.steps = 50;
        const Simulation part = simulate(model, options);
        REQUIRE(part.checkpoint.step == checkpoint_interval);
        options.steps = 80;
        options.resume = &part;
        const Simulation joined = simulate(model, options);
        check_same(whole, joined);
        CHECK(joined.report.newton_iterations == whole.report.newton_iterations);
        REQUIRE(joined.outputs.size() == 80);
        CHECK(joined.outputs.back().kinetic_energy == whole.outputs.back().kinetic_energy);

        const TemporaryFolder folder;
        const std::string path = folder.file("trajectory.json");
        REQUIRE(write_trajectory(path, part.trajectory, model, "", &part.checkpoint).empty());
        const auto stored = read_trajectory(path);
        for (const auto& e : stored.errors()) UNSCOPED_INFO(e.where << ": " << e.message);
        REQUIRE(stored.has_value());
        const auto resumed = resumable(*stored, model);
        REQUIRE(resumed.has_value());
        options.resume = &*resumed;
        check_same(whole, simulate(model, options));
    }
}

TEST_CASE("a run is not taken up by another scene", "[continuation]") {
    const model::Model model = tumbling_box(scene::Integrator::implicit_euler);
    SimulationOptions options;
    options.steps = 40;
    const Simulation run = simulate(model, options);
    StoredTrajectory stored;
    stored.trajectory = run.trajectory;
    stored.model = model;
    stored.checkpoint = run.checkpoint;
    stored.checkpoint_scene = scene_parts(model);
    REQUIRE(resumable(stored, model).has_value());
    const auto refusal = [&](const std::function<void(model::Model&)>& change) {
        model::Model other = model;
        change(other);
        const auto result = resumable(stored, other);
        return result ? std::string() : result.errors().at(0).message;
    };
    const auto named = [&](const std::string& part, const std::function<void(model::Model&)>& change) {
        INFO(part << ": " << refusal(change));
        CHECK(refusal(change).ends_with("differs in: " + part));
    };
    named("time step", [](auto& m) { m.timestep = 0.02; });
    named("integrator", [](auto& m) { m.integrator = scene::Integrator::newmark; });
    named("gravity", [](auto& m) { m.gravity.z() = -1.62; });
    named("contact model", [](auto& m) { m.dhat *= 2; });
    named("contact model", [](auto& m) { m.contact_damping_time = 1e-3; });
    named("friction", [](auto& m) { m.friction.mu *= 0.5; });
    named("solver's tolerance", [](auto& m) { m.velocity_tolerance *= 0.5; });
    named("solver's tolerance", [](auto& m) { m.solve_accuracy = 1e-3; });
    named("solver's tolerance", [](auto& m) { m.for_gradient = true; });
    named("masses", [](auto& m) { m.bodies[1].moments *= 2; });
    named("start poses", [](auto& m) { m.bodies[1].pose_start.position.x() += 1e-9; });
    named("start velocities", [](auto& m) { m.bodies[1].velocity_start *= -1; });
    named("motors and scripts", [](auto& m) { prescribe(m.bodies[1], 2, 1); });
    named("loads", [](auto& m) { m.bodies[1].force.x() = 1; });
    named("start poses, start velocities", [](auto& m) {
        m.bodies[1].pose_start.position.x() += 1;
        m.bodies[1].velocity_start *= 2;
    });
    model::Model looped = model;  // a loop has rows that follow from the others
    looped.mechanism.joints.emplace_back();
    looped.mechanism.dependent.emplace_back();
    const std::string before = scene_parts(looped).back().hash;
    looped.mechanism.dependent.back().constant = 1e-9;
    CHECK(scene_parts(looped).back().hash != before);
    CHECK(refusal([](auto& m) { m.bodies[1].mesh.vertices *= 1.01; }).find("meshes") != std::string::npos);
    stored.checkpoint->state.history.accelerations.resize(2);
    CHECK(refusal([](auto&) {}).find("integrator") != std::string::npos);
    stored.checkpoint.reset();
    CHECK(refusal([](auto&) {}).find("checkpoint") != std::string::npos);
}

TEST_CASE("kappa rises in a hard impact and falls again, and stays when it must", "[continuation]") {
    model::Model model = tumbling_box(scene::Integrator::implicit_euler);
    model.kappa *= 1e-4;  // so soft that the box comes close
    SimulationOptions options;
    options.steps = 120;
    options.outputs = true;
    const auto kappas = [&] {
        std::vector<double> out;
        for (const StepOutputs& o : simulate(model, options).outputs) out.push_back(o.kappa);
        return out;
    };
    const std::vector<double> adapted = kappas();
    REQUIRE(adapted.size() == 120);
    const double most = *std::max_element(adapted.begin(), adapted.end());
    CHECK(adapted.front() >= model.kappa);
    CHECK(most >= 4 * adapted.front());
    CHECK(adapted.back() < most);
    model.adaptive_kappa = false;
    for (const double kappa : kappas()) REQUIRE(kappa == model.kappa);
}

}  // namespace fettle::core::records::continuation_test
