// SPDX-License-Identifier: MIT
// What does a gradient cost? The flagship slider-crank of examples/slider_crank, the first steps of its turn: forward as for gradients, and
// the backward sweep, in milliseconds per step, with what the sweep takes per step (assemblies of a Hessian, factorisations, solves). How
// its time grows with the number of parameters, vertex coordinates, from 1 to 10,000: all of them are differentiated at once, and a
// parameter adds no more than the sum over its entries. The memory that a trajectory holds per body and step, and a contact. Before a time
// counts, the gradient is checked: along one random direction in the vertices by the tangent sweep, to 1e-6.
// Times are the least of several; the growth is that of the processor's. Prints JSON. Arguments: steps (40), the folder of the examples.
#include <sys/resource.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include "adjoint/stepper/reverse_sweep.hpp"
#include "adjoint/stepper/step_linearisation.hpp"
#include "adjoint/stepper/tangent_sweep.hpp"
#include "core/stepper/simulate.hpp"
#include "design/problem/design_problem.hpp"
#include "design/reading/design_reader.hpp"

using namespace fettle;
using namespace fettle::core;

namespace {

struct Times {
    double clock = INFINITY, processor = INFINITY;  ///< milliseconds per step
};

model::Model flagship(const std::string& folder) {
    auto file = design::reading::read_design(folder + "/slider_crank/slider_crank.design.json");
    if (file) {
        const auto problem = design::problem::DesignProblem::create(file->design);
        if (problem) {
            auto model = problem->model_at(design::description::values_of(problem->design().parameters));
            if (model) return std::move(model).value();
        }
    }
    std::fprintf(stderr, "the slider-crank cannot be made\n");
    std::exit(1);
}

// A seed of the last body's position, and a little of all poses.
adjoint::TrajectoryGradient seed_of(const model::Model& model, int steps) {
    adjoint::TrajectoryGradient seed = adjoint::zero_trajectory_gradient(steps, count_of(model.bodies));
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (auto& bodies : seed.pose_bar)
        for (Matrix34& bar : bodies) bar = Matrix34::NullaryExpr([&] { return unit(random); });
    return seed;
}

struct Entry {
    std::size_t body;
    Eigen::Index place;
};

// The times of the sweep and of the parameters that hang on these entries, each with weight 1.
Times sweep_times(const model::Model& model, const stepper::Trajectory& trajectory, const std::vector<Entry>& entries, int parameters) {
    const adjoint::TrajectoryGradient seed = seed_of(model, count_of(trajectory.steps));
    Times least;
    for (int trial = 0; trial < 9; ++trial) {
        const auto begin = std::chrono::steady_clock::now();
        const std::clock_t processor = std::clock();
        const auto gradients = adjoint::stepper::reverse_sweep(model, trajectory, {seed});
        if (!gradients) return {NAN, NAN};
        VectorX gradient(parameters);
        for (int k = 0; k < parameters; ++k) {
            const Entry& entry = entries[static_cast<std::size_t>(k) % entries.size()];
            gradient[k] = (*gradients)[0].bodies[entry.body].vertices_bar.reshaped()[entry.place];
        }
        if (!gradient.allFinite()) return {NAN, NAN};
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const double a_step = 1e3 / static_cast<double>(trajectory.steps.size());
        least.clock = std::min(least.clock, a_step * seconds);
        least.processor = std::min(least.processor, a_step * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    }
    return least;
}

// Forwards against backwards along a random direction in all vertices.
double disagreement(const model::Model& model, const stepper::Trajectory& trajectory) {
    const int steps = count_of(trajectory.steps);
    const adjoint::TrajectoryGradient seed = seed_of(model, steps);
    adjoint::ModelTangent direction = adjoint::zero_model_tangent(model, steps);
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (adjoint::BodyTangent& body : direction.bodies)
        for (double& v : body.vertices_dot.reshaped()) v = 1e-3 * unit(random);
    const auto backwards = adjoint::stepper::reverse_sweep(model, trajectory, {seed});
    const auto forwards = adjoint::stepper::tangent_sweep(model, trajectory, direction);
    if (!backwards || !forwards) {
        std::fprintf(stderr, "%s\n", (!backwards ? backwards.errors() : forwards.errors())[0].message.c_str());
        return INFINITY;
    }
    double a = 0, b = 0;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        a += (*backwards)[0].bodies[i].vertices_bar.cwiseProduct(direction.bodies[i].vertices_dot).sum();
        for (std::size_t t = 0; t < trajectory.poses.size(); ++t) {
            Matrix34 dot;
            dot << cross_matrix((*forwards)[t][i].tail<3>()) * trajectory.poses[t][i].rotation, (*forwards)[t][i].head<3>();
            b += seed.pose_bar[t][i].cwiseProduct(dot).sum();
        }
    }
    return std::abs(a - b) / std::abs(b);
}

double bytes_per_body_and_step(const stepper::Trajectory& t) {
    double bytes = 0;
    for (const auto& poses : t.poses) bytes += static_cast<double>(poses.size() * sizeof(kinematics::Pose));
    for (const stepper::TrajectoryStep& step : t.steps) {
        for (const auto* list : {&step.nodes, &step.friction_rounds})
            for (const auto& points : *list) bytes += static_cast<double>(points.size() * sizeof(kinematics::ChartPoint));
        bytes += static_cast<double>(step.fractions.size() * sizeof(double));
    }
    return bytes / static_cast<double>(t.steps.size() * t.poses[0].size());
}

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
    int steps = 40;
    std::string examples = "examples";
    CLI::App app("The slider-crank's gradient beside its simulation; prints JSON.");
    app.add_option("steps", steps, "time steps")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("examples", examples, "their folder")->check(CLI::ExistingDirectory)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    const model::Model model = flagship(examples);
    stepper::SimulationOptions options;
    options.steps = steps;
    options.for_gradient = true;
    stepper::Simulation done = stepper::simulate(model, options);
    for (int trial = 0; trial < 2; ++trial)
        done.report.wall_seconds = std::min(done.report.wall_seconds, stepper::simulate(model, options).report.wall_seconds);
    if (done.report.status != stepper::SimulationStatus::ok) {
        std::fprintf(stderr, "%s\n", done.report.message.c_str());
        return 1;
    }
    const double forward = 1e3 * done.report.wall_seconds / steps, before = peak_megabytes();
    adjoint::stepper::SweepCounts counts;
    const auto first = adjoint::stepper::reverse_sweep(model, done.trajectory, {seed_of(model, steps)}, &counts);
    const double after = peak_megabytes();
    int contacts = 0;
    for (const stepper::StepReport& step : done.report.steps) contacts = std::max(contacts, step.contacts);
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < model.bodies.size(); ++i)
        for (Eigen::Index k = 0; k < model.bodies[i].mesh.vertices.size(); ++k) entries.push_back({i, k});
    const double backward = sweep_times(model, done.trajectory, entries, 1).clock;
    const double error = disagreement(model, done.trajectory);
    const bool right = first && error < 1e-6;
    std::printf("{\n  \"steps\": %d, \"bodies\": %zu, \"contacts\": %d, \"vertex_coordinates\": %zu,\n", steps, model.bodies.size(),
                contacts, entries.size());
    std::printf("  \"forward_ms\": %.2f, \"newton_per_step\": %.1f, \"backward_ms\": %.2f, \"backward_by_forward\": %.3f,\n", forward,
                static_cast<double>(done.report.newton_iterations) / steps, backward, backward / forward);
    std::printf("  \"assemblies_per_step\": %.2f, \"factorisations_per_step\": %.2f, \"solves_per_step\": %.2f,\n",
                static_cast<double>(counts.assemblies) / steps, static_cast<double>(counts.factorisations) / steps,
                static_cast<double>(counts.solves) / steps);
    std::printf("  \"trajectory_bytes_per_body_and_step\": %.0f, \"contact_bytes\": %zu, \"sweep_peak_megabytes\": %.1f,\n",
                bytes_per_body_and_step(done.trajectory), sizeof(contact::ContactPair), after - before);
    std::printf("  \"by_parameters\": [\n");
    double one = 0;
    for (const int parameters : {1, 10, 100, 1000, 10000}) {
        const Times times = sweep_times(model, done.trajectory, entries, parameters);
        if (parameters == 1) one = times.processor;
        std::printf("    {\"parameters\": %d, \"clock_ms\": %.3f, \"processor_ms\": %.3f, \"to_one\": %.3f}%s\n", parameters, times.clock,
                    times.processor, times.processor / one, parameters == 10000 ? "" : ",");
    }
    std::printf("  ],\n  \"disagreement\": %.2g, \"right\": %s\n}\n", error, right ? "true" : "false");
    return right ? 0 : 1;
}
