// SPDX-License-Identifier: MIT
// A scene made in memory: a cube falls 1 mm onto a table, and comes to rest. SI units throughout.
#include <cstdio>

#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "design/shapes/file_part.hpp"

namespace core = fettle::core;

// A body with the library's box for its mesh. A static body has all its coordinates held.
core::scene::Body box(const std::string& name, core::scene::BodyType type, double side, double height) {
    core::scene::Body body;
    body.name = name;
    body.type = type;
    const auto part = fettle::design::shapes::FilePart::create("box", {{"size_x", side}, {"size_y", side}, {"size_z", height}});
    body.mesh = drawn_mesh(**part).value();
    if (type == core::scene::BodyType::static_body) body.prescribed.fill(core::scene::MotionCurve{});
    return body;
}

int main() {
    core::scene::Scene scene;
    scene.gravity = {0, 0, -9.81};
    scene.timestep = 0.005;
    scene.end_time = 0.2;
    scene.bodies.push_back(box("table", core::scene::BodyType::static_body, 0.05, 0.01));
    scene.bodies.push_back(box("cube", core::scene::BodyType::dynamic_body, 0.01, 0.01));
    scene.bodies[0].pose.position = {0, 0, -0.005};
    scene.bodies[1].pose.position = {0, 0, 0.006};
    scene.bodies[1].density = 1240;

    const auto model = core::setup::build_model(scene);
    for (const auto& error : model.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
    if (!model) return 3;

    const core::stepper::Simulation simulation = core::stepper::simulate(*model);
    const auto& poses = simulation.trajectory.poses;
    for (std::size_t t = 0; t < poses.size(); t += 10)
        std::printf("%.3f s: the cube's middle is at %.4f mm\n", core::stepper::time_at(simulation.trajectory, static_cast<int>(t)),
                    1000 * poses[t][1].position.z());
    std::printf("%s: %zu steps, %.4f mm above the table\n", core::stepper::to_string(simulation.report.status),
                simulation.report.steps.size(), 1000 * poses.back()[1].position.z() - 5);
    return simulation.report.status == core::stepper::SimulationStatus::ok ? 0 : 2;
}
