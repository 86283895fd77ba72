// SPDX-License-Identifier: MIT
#include "tests/benchmarks/scene_run.hpp"

#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <numeric>

#include "core/base/parallel.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "tests/benchmarks/child_run.hpp"
#include "tests/benchmarks/scene_row.hpp"
#include "tests/support/intersection_oracle.hpp"

namespace fettle::tests::benchmarks {
namespace {

using core::stepper::Simulation;
using core::stepper::Trajectory;

double clock_seconds(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::uint64_t bits_of(const Trajectory& trajectory) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3u; };
    for (const auto& poses : trajectory.poses)
        for (const auto& pose : poses) {
            for (const double x : pose.rotation.reshaped()) add(x);
            for (const double x : pose.position) add(x);
        }
    return hash;
}

bool is_finite(const Trajectory& trajectory) {
    for (const auto& poses : trajectory.poses)
        for (const auto& pose : poses) {
            if (!pose.position.allFinite() || !pose.rotation.allFinite()) return false;
            if (!((pose.rotation.transpose() * pose.rotation - Matrix3::Identity()).norm() < 1e-12)) return false;
        }
    return true;
}

/// All steps, in an order that spreads whatever part of them there is time for: 0, then strides that halve.
std::vector<int> spread_order(int count) {
    std::vector<int> order;
    std::vector<bool> taken(count, false);
    int stride = 1;
    while (stride < count) stride *= 2;
    for (; stride >= 1; stride /= 2)
        for (int i = 0; i < count; i += stride) {
            if (taken[i]) continue;
            taken[i] = true;
            order.push_back(i);
        }
    return order;
}

void check_intersections(const core::model::Model& model, const Trajectory& trajectory, const RunOptions& options, SceneRow& row) {
    constexpr std::size_t enough = 10;
    support::IntersectionReport found;
    const support::IntersectionOracle oracle(model);
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (const int step : spread_order(count_of(trajectory.steps))) {
        oracle.look_at_step(trajectory, step, options.instants_between, enough, found);
        ++row.steps_checked;
        if (found.intersections.size() >= enough || clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start > options.check_seconds) break;
    }
    row.intersections = static_cast<long>(found.intersections.size());
    if (row.intersections > 0) row.first_intersection = to_string(found.intersections.front(), model);
}

/// One timed run; the row keeps the quickest.
Simulation timed_run(const core::model::Model& model, const RunOptions& options, SceneRow& row) {
    const clockid_t cpu = options.threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
    const double cpu_start = clock_seconds(cpu), wall_start = clock_seconds(CLOCK_MONOTONIC);
    core::stepper::SimulationOptions simulation;
    simulation.steps = options.steps;
    simulation.should_stop = [&] { return clock_seconds(cpu) - cpu_start > options.seconds; };
    simulation.on_step = [&](const core::stepper::Progress& progress) { row.steps_wanted = progress.steps; };
    Simulation run = core::stepper::simulate(model, simulation);
    const double cpu_seconds = clock_seconds(cpu) - cpu_start, wall_seconds = clock_seconds(CLOCK_MONOTONIC) - wall_start;
    if (row.cpu_seconds == 0 || cpu_seconds < row.cpu_seconds) row.cpu_seconds = cpu_seconds;
    if (row.wall_seconds == 0 || wall_seconds < row.wall_seconds) row.wall_seconds = wall_seconds;
    return run;
}

void describe(const Simulation& run, SceneRow& row) {
    row.status = to_string(run.report.status);
    row.message = run.report.message;
    row.steps = count_of(run.trajectory.steps);
    row.newton_iterations = run.report.newton_iterations;
    row.minimum_distance = std::numeric_limits<double>::infinity();
    for (const core::stepper::StepReport& step : run.report.steps) {
        row.contacts += step.contacts;
        row.minimum_distance = std::min(row.minimum_distance, step.minimum_distance);
    }
    for (std::size_t i = 0; i < run.report.phase_seconds.size(); ++i)
        row.phases[to_string(static_cast<core::solver::SolvePhase>(i))] = run.report.phase_seconds[i];
    row.bits = bits_of(run.trajectory);
    row.finite = is_finite(run.trajectory);
}

SceneRow refused(SceneRow row, const core::base::Errors& errors) {
    row.status = "refused";
    row.message = errors.front().where + ": " + errors.front().message;
    return row;
}

}  // namespace

SceneRow run_here(const std::string& name, const std::string& text, const std::string& path, const RunOptions& options) {
    SceneRow row;
    row.scene = name;
    const core::base::ThreadLimit limit(options.threads);
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    const auto scene = core::scene_files::parse_scene(text, path);
    if (!scene) return refused(row, scene.errors());
    const auto model = core::setup::build_model(*scene);
    if (!model) return refused(row, model.errors());
    row.build_seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    row.bodies = static_cast<long>(model->bodies.size());
    for (const core::model::Body& body : model->bodies) row.triangles += static_cast<long>(body.mesh.triangles.size());

    const Simulation run = timed_run(*model, options, row);
    row.peak_memory_bytes = peak_memory_bytes();
    describe(run, row);
    double spent = row.cpu_seconds;
    for (int i = 1; i < options.repeat && run.report.status == core::stepper::SimulationStatus::ok && spent < options.repeat_seconds; ++i) {
        const double before = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
        row.repeatable &= bits_of(timed_run(*model, options, row).trajectory) == row.bits;
        spent += clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
    }
    check_intersections(*model, run.trajectory, options, row);
    return row;
}

SceneRow run_apart(const std::string& name, const std::string& text, const std::string& path, const RunOptions& options) {
    SceneRow failed;
    failed.scene = name;
    failed.status = "crashed";
    // A run that hangs where it does not ask `should_stop` is ended by the kernel.
    const double limit = options.threads * (3 * options.seconds + options.check_seconds + 2 * options.repeat_seconds) + 60;
    const auto work = [&] {
        const std::string row = to_json(run_here(name, text, path, options));
        return std::fwrite(row.data(), 1, row.size(), stdout) == row.size() ? 0 : 1;
    };
    const ChildRun child = run_child(work, limit);
    if (child.signal != 0) {
        if (child.ran_out_of_time()) failed.status = "hung";
        failed.message = std::string("signal ") + strsignal(child.signal);
    }
    if (child.exit_code != 0) return failed;
    return row_from_json(child.out).value_or(failed);
}

}  // namespace fettle::tests::benchmarks
