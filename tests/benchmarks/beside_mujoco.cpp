// SPDX-License-Identifier: MIT
// How fast is the program beside what people use for rigid bodies? Unit cubes on a plane (box_scenes.hpp: a tower, a wall, a pile that is
// dropped) in fettle and in MuJoCo, one thread each. Prints a JSON row per scene, times of the processor:
//   fettle   ms a step of the whole program, `fettle simulate` as a process of its own from its start to the end of the proof, and of
//            stepping: its share of that by the program's own clocks; the least distance, proven over the whole path
//   MuJoCo   ms a step of mj_step alone; the deepest penetration, by the least `dist` of the contacts of all steps
// Ratios are fettle's time over MuJoCo's: `program_ratio` charges fettle with everything and MuJoCo with mj_step alone.
// What is the same: masses, gravity, friction 0.5, steps of 0.01 s. What each does its own way: MuJoCo's contacts are soft (its default
// time constant of 0.02 s), its friction has elliptic cones, as Coulomb's law has, solved by its default, Newton's method; boxes and the
// plane are its primitives. fettle's are meshes of 12 and 2 triangles with a dhat of 1 mm, and friction has one round a step.
//
//   beside_mujoco [tower wall pile] [--steps N] [--cone pyramidal] [--scenes DIR: writes the scenes there, and keeps them]
#include <mujoco/mujoco.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "tests/benchmarks/box_scenes.hpp"
#include "tests/benchmarks/child_run.hpp"
#include "tests/benchmarks/program_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace fettle::tests;
using namespace fettle::tests::benchmarks;

namespace {

struct Command {
    std::vector<std::string> names;
    int steps = 0;
    std::string cone = "elliptic", folder;
    double seconds = 300;
    int repeat = 5;
    double repeat_seconds = 2;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct MujocoRun {
    bool ok = false;
    double stepping_seconds = 0;
    double least_distance = INFINITY;
    int most_contacts = 0;
};

// In a child. Prints: seconds of stepping, least distance, most contacts.
int step_mujoco(const std::string& path, const Command& command, int steps) {
    mju_user_warning = [](const char* text) { std::fprintf(stderr, "MuJoCo: %s\n", text); };  // else into a file where it stands
    char error[1000] = "";
    mjModel* model = mj_loadXML(path.c_str(), nullptr, error, sizeof error);
    if (model == nullptr) return std::fprintf(stderr, "%s: %s\n", path.c_str(), error), 3;
    model->opt.cone = command.cone == "elliptic" ? mjCONE_ELLIPTIC : mjCONE_PYRAMIDAL;
    mjData* data = mj_makeData(model);
    const double begin = cpu_seconds();
    double least = INFINITY;
    int most = 0;
    for (int i = 0; i < steps; ++i) {
        mj_step(model, data);
        for (int c = 0; c < data->ncon; ++c) least = std::min(least, data->contact[c].dist);
        most = std::max(most, data->ncon);
    }
    const double seconds = cpu_seconds() - begin;
    bool warned = false;  // of contacts left out for want of room, or positions that are no numbers
    for (const mjWarningStat& warning : data->warning) warned = warned || warning.number > 0;
    std::printf("%.17g %.17g %d\n", seconds, least, most);
    return warned ? 2 : 0;
}

MujocoRun run_mujoco(const std::string& path, const Command& command, int steps) {
    MujocoRun best;
    double spent = 0;
    for (int i = 0; i < command.repeat && (i == 0 || spent < command.repeat_seconds); ++i) {
        const ChildRun child = run_child([&] { return step_mujoco(path, command, steps); }, command.seconds);
        MujocoRun run;
        run.ok = child.exit_code == 0 &&
                 std::sscanf(child.out.c_str(), "%lf %lf %d", &run.stepping_seconds, &run.least_distance, &run.most_contacts) == 3;
        if (!run.ok) return run;
        spent += child.cpu_seconds;
        if (i == 0 || run.stepping_seconds < best.stepping_seconds) best = run;
    }
    return best;
}

std::string write(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
}

/// Returns whether both ran.
bool compare(const BoxScene& scene, const Command& command, const std::filesystem::path& folder) {
    const int steps = command.steps > 0 ? command.steps : scene.steps;
    const std::string ours = write(folder, scene.name + ".scene.json", fettle_scene(scene));
    const std::string theirs = write(folder, scene.name + ".xml", mujoco_scene(scene));
    ProgramOptions options;
    options.program = program_of_this_build();
    options.steps = steps;
    options.seconds = command.seconds;
    options.repeat = command.repeat;
    options.repeat_seconds = command.repeat_seconds;
    const ProgramRun run = run_program(ours, options);
    const MujocoRun mujoco = run_mujoco(theirs, command, steps);
    const auto milliseconds = [&](double seconds) { return 1e3 * seconds / steps; };
    const double told = run.start_seconds + run.stepping_seconds + run.certify_seconds;
    const double stepping = run.cpu_seconds * run.stepping_seconds / told;
    std::printf("{\"scene\": \"%s\", \"bodies\": %zu, \"steps\": %d,\n", scene.name.c_str(), scene.centers.size(), steps);
    std::printf(
        "  \"fettle\": {\"status\": \"%s\", \"program_ms_per_step\": %.4g, \"stepping_ms_per_step\": %.4g, \"proven_least_distance\": "
        "%.4g},\n",
        run.status.c_str(), milliseconds(run.cpu_seconds), milliseconds(stepping), run.minimum_distance);
    std::printf(
        "  \"mujoco\": {\"status\": \"%s\", \"cone\": \"%s\", \"ms_per_step\": %.4g, \"deepest_penetration\": %.4g, "
        "\"most_contacts\": %d},\n",
        mujoco.ok ? "ok" : "failed", command.cone.c_str(), milliseconds(mujoco.stepping_seconds), std::max(0.0, -mujoco.least_distance),
        mujoco.most_contacts);
    std::printf("  \"program_ratio\": %.4g, \"stepping_ratio\": %.4g}\n", run.cpu_seconds / mujoco.stepping_seconds,
                stepping / mujoco.stepping_seconds);
    std::fflush(stdout);
    return run.status == "ok" && mujoco.ok;
}

}  // namespace

int main(int argc, char** argv) {
    Command command;
    CLI::App app("Unit cubes on a plane, in fettle and in MuJoCo; prints JSON rows.");
    app.add_option("scenes", command.names, "tower, wall, pile (default: all)");
    app.add_option("--steps", command.steps, "time steps; default 200");
    app.add_option("--cone", command.cone, "of MuJoCo's friction")->check(CLI::IsMember({"elliptic", "pyramidal"}))->capture_default_str();
    app.add_option("--seconds", command.seconds, "CPU time per run")->capture_default_str();
    app.add_option("--repeat", command.repeat, "short runs up to so often")->capture_default_str();
    app.add_option("--scenes", command.folder, "write the scenes here, and keep them");
    CLI11_PARSE(app, argc, argv);
    const support::TemporaryFolder temporary;
    const std::filesystem::path folder = command.folder.empty() ? temporary.path : std::filesystem::path(command.folder);
    std::filesystem::create_directories(folder);
    bool ok = true;
    for (const BoxScene& scene : box_scenes()) {
        const bool asked =
            command.names.empty() || std::find(command.names.begin(), command.names.end(), scene.name) != command.names.end();
        if (asked) ok = compare(scene, command, folder) && ok;
    }
    return ok ? 0 : 1;
}
