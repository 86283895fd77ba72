// SPDX-License-Identifier: MIT
// What does a step with joints cost? A chain of revolute joints that falls from the horizontal, at several lengths, forward (as a
// simulation and as for gradients) and backward, and a four-bar that a motor turns. Milliseconds of the clock per step. Before a time
// counts, the answer is checked: joints met to 1e-9 of the scene's size, energy that does not grow, the four-bar's tip by trigonometry.
// Prints JSON. Arguments: links of the longest chain (1000), steps (200).
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/support/box_mesh.hpp"

using namespace fettle;
using namespace fettle::core;

namespace {

scene::Body bar(const std::string& name, double length, const Vector3& position, double turn = 0) {
    scene::Body body;
    body.name = name;
    body.mesh = tests::support::box_mesh(Vector3(0, -0.01, -0.01), Vector3(length, 0.01, 0.01));
    body.pose.position = position;
    body.pose.rotation = kinematics::rotation(Vector3(0, 0, turn));
    body.group = 0;
    return body;
}

scene::Joint hinge(const std::string& name, const scene::Attachment& a, const scene::Attachment& b) {
    scene::Joint joint;
    joint.name = name;
    joint.a = a;
    joint.b = b;
    return joint;
}

model::Model built(const scene::Scene& scene) {
    auto model = setup::build_model(scene);
    if (model) return std::move(model).value();
    std::fprintf(stderr, "%s\n", model.errors()[0].message.c_str());
    std::exit(1);
}

model::Model chain(int links) {
    constexpr double length = 0.1;
    scene::Scene scene;
    scene.timestep = 0.005;
    scene.gravity = Vector3(0, -9.81, 0);
    for (int k = 0; k < links; ++k) {
        scene.bodies.push_back(bar("link" + std::to_string(k), length, Vector3(k * length, 0, 0)));
        const scene::Attachment before{k > 0 ? "link" + std::to_string(k - 1) : "", Vector3(k > 0 ? length : 0, 0, 0), Vector3::UnitZ()};
        scene.mechanism.joints.push_back(
            hinge("hinge" + std::to_string(k), before, {"link" + std::to_string(k), Vector3::Zero(), Vector3::UnitZ()}));
    }
    return built(scene);
}

constexpr double crank = 0.1, coupler = 0.35, rocker = 0.25, ground = 0.3;

Vector3 tip(double angle) {
    const Vector3 a(crank * std::cos(angle), crank * std::sin(angle), 0), d(ground - a.x(), -a.y(), 0);
    const double span = d.norm(), along = (coupler * coupler - rocker * rocker + span * span) / (2 * span);
    return a + along / span * d + std::sqrt(coupler * coupler - along * along) / span * Vector3(-d.y(), d.x(), 0);
}

model::Model four_bar(int steps) {
    const Vector3 a(crank, 0, 0), b = tip(0), o(ground, 0, 0), z = Vector3::UnitZ();
    scene::Scene scene;
    scene.timestep = 1.0 / steps;
    scene.bodies = {bar("crank", crank, Vector3::Zero()), bar("coupler", coupler, a, std::atan2(b.y() - a.y(), b.x() - a.x())),
                    bar("rocker", rocker, o, std::atan2(b.y(), b.x() - ground))};
    scene.mechanism.joints = {hinge("O", {"", Vector3::Zero(), z}, {"crank", Vector3::Zero(), z}),
                              hinge("A", {"crank", Vector3(crank, 0, 0), z}, {"coupler", Vector3::Zero(), z}),
                              hinge("B", {"coupler", Vector3(coupler, 0, 0), z}, {"rocker", Vector3(rocker, 0, 0), z}),
                              hinge("C", {"", o, z}, {"rocker", Vector3::Zero(), z})};
    scene::Motor motor;
    motor.name = "drive";
    motor.joint = "O";
    motor.curve.rate = 2 * M_PI;
    scene.mechanism.motors = {motor};
    return built(scene);
}

struct Run {
    stepper::Simulation simulation;
    double milliseconds = 0;  ///< per step
    bool is_right = false;
};

Run run(const model::Model& model, int steps, bool for_gradient) {
    stepper::SimulationOptions options;
    options.steps = steps;
    options.for_gradient = for_gradient;
    Run out;
    out.simulation = stepper::simulate(model, options);
    out.milliseconds = 1e3 * out.simulation.report.wall_seconds / steps;
    out.is_right = out.simulation.report.status == stepper::SimulationStatus::ok;
    for (const stepper::StepReport& step : out.simulation.report.steps)
        out.is_right = out.is_right && step.joint_gap <= 1e-9 * model.diagonal;
    return out;
}

// The energy of gravity and of motion, by the last two configurations.
double energy(const model::Model& model, const stepper::Trajectory& t) {
    double sum = 0;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        const Matrix34 end = pose_matrix(t.poses.back()[i]),
                       velocity = (end - pose_matrix(t.poses[t.poses.size() - 2][i])) / model.timestep;
        const Matrix4& m = model.bodies[i].moments;
        sum += 0.5 * (velocity * m).cwiseProduct(velocity).sum() - model.gravity.dot(end * m.col(3));
    }
    return sum;
}

double backward_milliseconds(const model::Model& model, const stepper::Trajectory& trajectory) {
    adjoint::TrajectoryGradient seed = adjoint::zero_trajectory_gradient(count_of(trajectory.steps), count_of(model.bodies));
    seed.pose_bar.back().back()(1, 3) = 1;
    const auto begin = std::chrono::steady_clock::now();
    const auto gradient = adjoint::stepper::reverse_sweep(model, trajectory, {seed});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return gradient ? 1e3 * seconds / static_cast<double>(trajectory.steps.size()) : NAN;
}

bool chain_row(int links, int steps) {
    const model::Model model = chain(links);
    const Run plain = run(model, steps, false), exact = run(model, std::min(steps, 50), true);
    const bool right = plain.is_right && exact.is_right && energy(model, plain.simulation.trajectory) <= 1e-9;
    std::printf(
        "    {\"links\": %d, \"forward_ms\": %.3f, \"newton_per_step\": %.2f, \"for_gradient_ms\": %.3f, \"backward_ms\": %.3f, \"right\": "
        "%s}",
        links, plain.milliseconds, static_cast<double>(plain.simulation.report.newton_iterations) / steps, exact.milliseconds,
        backward_milliseconds(model, exact.simulation.trajectory), right ? "true" : "false");
    return right;
}

bool four_bar_row() {
    constexpr int steps = 1000;
    const model::Model model = four_bar(steps);
    const Run plain = run(model, steps, false);
    double worst = 0;
    for (int t = 0; t <= steps && plain.is_right; ++t) {
        const Vector3 end =
            kinematics::world_position(plain.simulation.trajectory.poses[t][1], Vector3(coupler, 0, 0) - model.bodies[1].reference_point);
        worst = std::max(worst, (end - tip(2 * M_PI * t / steps)).norm());
    }
    const bool right = plain.is_right && worst <= 1e-9 * ground;
    std::printf("  \"four_bar\": {\"forward_ms\": %.4f, \"worst_position\": %.3g, \"right\": %s}\n", plain.milliseconds, worst,
                right ? "true" : "false");
    return right;
}

}  // namespace

int main(int argc, char** argv) {
    int longest = 1000, steps = 200;
    CLI::App app("Steps of a chain of hinges and of a four-bar; prints JSON.");
    app.add_option("links", longest, "of the longest chain")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("steps", steps, "time steps")->check(CLI::PositiveNumber)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    std::printf("{\n  \"chain\": [\n");
    bool right = true;
    for (const int links : {longest / 100, longest / 10, longest}) {
        right = chain_row(std::max(1, links), steps) && right;
        std::printf(links == longest ? "\n  ],\n" : ",\n");
    }
    right = four_bar_row() && right;
    std::printf("}\n");
    return right ? 0 : 1;
}
