// SPDX-License-Identifier: MIT
// How fast, and how soundly, do the paper's scenes run? One JSON row per scene on stdout, then a summary, a table on stderr. The whole
// program is timed for each scene, `fettle simulate --threads 1` as a process of its own from its start to the end of the proof (CPU
// seconds of user and kernel), and compared with the reference program's whole process. Beside it the phases of stepping, in another
// process, where the run is checked: status, finite poses, repeated runs of the same bits, no intersection by exact predicates at nodes and
// between,
// peak memory. Exit code 1 if a check fails, or the program does not end "ok".
//
//   scenes_benchmark                              the scenes and steps of docs/reference_seconds.tsv
//   scenes_benchmark pendulum/pendulum a.json     these, by name under $FETTLE_SHARED/scenes/fixtures or by path; --steps N
//   scenes_benchmark --program-only ...           no phases and no checks: the whole program alone
//   scenes_benchmark --all-fixtures --seconds 60  every scene there, to its own end or that much CPU time: hunts stalls and NaN
//   scenes_benchmark --net 32                     cost per body and contact of n x n chain nets, n = 4, 8, .. 32
//   scenes_benchmark --threads-compared SCENE ... the same results at 1, 2 and 4 threads? how much faster, as a whole program?
//   scenes_benchmark --save-baseline[=FILE], --compare[=FILE]    FILE: tests/benchmarks/scenes_baseline.json unless given
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "core/files/atomic_file.hpp"
#include "tests/benchmarks/reference_table.hpp"
#include "tests/benchmarks/scene_row.hpp"
#include "tests/benchmarks/scene_summary.hpp"
#include "tests/support/chain_net.hpp"
#include "tests/support/shared_files.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace fettle;
using namespace fettle::tests::benchmarks;
namespace fs = std::filesystem;

namespace {

struct Command {
    std::vector<std::string> scenes;
    int largest_net = 0;
    bool all_fixtures = false, threads_compared = false, program_only = false, table = false;
    std::string save, compare;
    RunOptions run;
    ProgramOptions program;
    std::vector<ReferenceRun> references;
};

/// What to run: a name for the rows, the scene's file.
struct Job {
    std::string name, path;
    int steps = -1;
};

fs::path fixtures() { return tests::support::shared_folder() / "scenes/fixtures"; }

Job file_job(const std::string& given, int steps) {
    const fs::path under = fixtures() / (given + ".json");
    return {given, (fs::exists(under) ? under : fs::path(given)).string(), steps};
}

// Beside the link's mesh in no folder of its own: `--mesh-dir` says where that is.
Job net_job(int n, int steps, const tests::support::TemporaryFolder& folder) {
    const std::string name = "net-" + std::to_string(n) + "x" + std::to_string(n);
    return {name, folder.write(name + ".json", tests::support::chain_net_scene(n)), steps};
}

std::vector<Job> jobs_of(const Command& command, const tests::support::TemporaryFolder& folder) {
    std::vector<Job> jobs;
    const int steps = command.run.steps;
    for (int n = 4; n <= command.largest_net; n *= 2) jobs.push_back(net_job(n, steps < 0 ? 63 : steps, folder));
    for (const std::string& name : command.scenes) {
        const ReferenceRun* reference = find_reference(command.references, name);
        jobs.push_back(file_job(name, steps < 0 && reference != nullptr ? reference->steps : steps));
    }
    if (command.all_fixtures) {
        std::vector<std::string> names;
        for (const auto& file : fs::recursive_directory_iterator(fixtures()))
            if (file.path().extension() == ".json")
                names.push_back(file.path().lexically_relative(fixtures()).replace_extension().string());
        std::sort(names.begin(), names.end());
        for (const std::string& name : names) jobs.push_back(file_job(name, steps));
    }
    if (command.table)
        for (const ReferenceRun& run : command.references)
            jobs.push_back(file_job(run.scene, steps < 0 ? run.steps : std::min(steps, run.steps)));
    return jobs;
}

/// One after another; prints rows, returns them.
class Runner {
public:
    explicit Runner(const Command& command) : command_(command) {
        if (command.compare.empty()) return;
        const auto rows = read_baseline(command.compare);
        if (!rows) std::exit(3);
        baseline_ = *rows;
    }

    SceneRow run(const Job& job) {
        SceneRow row;
        row.scene = job.name;
        row.status = "ok";
        if (!command_.program_only) row = checked_run(job);
        row.program = program_run(job, 1, command_.run.repeat);
        const bool over_memory = row.peak_memory_bytes > row.memory_limit_bytes();
        if (row.status != "ok" || row.program.status != "ok" || !row.is_sound() || over_memory) ++failures_;
        std::printf("%s\n", to_json(row, comparisons(row)).c_str());
        std::fflush(stdout);
        return row;
    }

    // In turn: what else the machine does, it does to all. The quickest of each counts.
    void compare_threads(const Job& job) {
        std::array<ProgramRun, 3> runs;
        bool same = true;
        for (int round = 0; round < command_.run.repeat; ++round) {
            for (std::size_t i = 0; i < runs.size(); ++i) {
                ProgramRun run = program_run(job, 1 << i, 1);
                const bool quickest = round == 0 || run.wall_seconds < runs[i].wall_seconds;
                if (quickest) runs[i] = std::move(run);
                same = same && runs[i].status == runs[0].status && runs[i].bits == runs[0].bits;
            }
        }
        std::string text = "{\"threads_compared\": \"" + job.name + "\"";
        for (std::size_t i = 0; i < runs.size(); ++i) text += ", " + member("wall_seconds_" + std::to_string(1 << i), runs[i].wall_seconds);
        if (!same || runs[0].status != "ok") ++failures_;
        std::printf("%s, \"status\": \"%s\", \"same_results\": %s, %s, %s}\n", text.c_str(), runs[0].status.c_str(),
                    same ? "true" : "false", member("speedup_2", runs[0].wall_seconds / runs[1].wall_seconds).c_str(),
                    member("speedup_4", runs[0].wall_seconds / runs[2].wall_seconds).c_str());
        std::fflush(stdout);
    }

    int finish(const std::vector<SceneRow>& rows) const {
        std::string text = "{\"summary\": true, \"failures\": " + std::to_string(failures_);
        if (!rows.empty()) text += ", " + summary_json(rows, command_.references);
        if (against_baseline_.count() > 0) text += ", " + against_baseline_.json("against_baseline");
        std::printf("%s}\n", text.c_str());
        return failures_ > 0 ? 1 : 0;
    }

private:
    SceneRow checked_run(const Job& job) const {
        const auto text = core::files::read_file(job.path);
        if (!text) {
            std::fprintf(stderr, "%s: %s\n", job.path.c_str(), text.errors().front().message.c_str());
            std::exit(3);
        }
        RunOptions options = command_.run;
        options.steps = job.steps;
        // A scene in another folder finds its meshes as if it stood among the others.
        const bool elsewhere = !command_.program.mesh_dir.empty() && job.path.rfind(fixtures().string(), 0) != 0;
        return run_apart(job.name, *text, elsewhere ? (fixtures() / "chain/chain-net/generated.json").string() : job.path, options);
    }

    ProgramRun program_run(const Job& job, int threads, int repeat) const {
        ProgramOptions options = command_.program;
        options.steps = job.steps;
        options.threads = threads;
        options.seconds = threads * command_.run.seconds;
        options.repeat = repeat;
        return run_program(job.path, options);
    }

    std::string comparisons(const SceneRow& row) {
        std::string text = member("program_seconds", row.program.cpu_seconds);
        if (row.contacts > 0) text += ", " + member("microseconds_per_contact", 1e6 * row.cpu_seconds / static_cast<double>(row.contacts));
        if (const ReferenceRun* reference = find_reference(command_.references, row.scene)) {
            text += ", " + member("reference_seconds", reference->seconds_of(row.program.steps));
            text += ", " + member("reference_ratio", reference_ratio(reference, row));
        }
        const SceneRow* before = find_row(baseline_, row.scene);
        if (before != nullptr && row.program.steps > 0 && before->program.steps > 0) {
            const auto per_step = [](const SceneRow& each) { return each.program.cpu_seconds / each.program.steps; };
            const double ratio = per_step(*before) / per_step(row);
            text += ", " + member("baseline_ratio", ratio);
            if (before->program.steps != row.program.steps) text += ", \"baseline_steps\": " + std::to_string(before->program.steps);
            against_baseline_.add(ratio, row.scene);
        }
        return text;
    }

    const Command& command_;
    std::vector<SceneRow> baseline_;
    Ratios against_baseline_;
    int failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    const std::string baseline_file = FETTLE_SOURCE_DIR "/tests/benchmarks/scenes_baseline.json";
    Command command;
    CLI::App app("Runs, times and checks scenes; prints JSON rows.");
    app.add_option("scenes", command.scenes, "names under $FETTLE_SHARED/scenes/fixtures, or files");
    app.add_option("--steps", command.run.steps, "time steps; default the reference's, else the scene's own");
    app.add_option("--seconds", command.run.seconds, "CPU time per scene")->capture_default_str();
    app.add_option("--check-seconds", command.run.check_seconds, "CPU time for looking for intersections")->capture_default_str();
    app.add_option("--instants", command.run.instants_between, "looked at between two nodes")->capture_default_str();
    app.add_option("--repeat", command.run.repeat, "short runs up to so often")->capture_default_str();
    app.add_option("--net", command.largest_net, "chain nets 4x4, 8x8, ... up to this size");
    app.add_flag("--all-fixtures", command.all_fixtures, "every scene, to its own end");
    app.add_flag("--program-only", command.program_only, "the whole program alone: no phases, no checks");
    app.add_flag("--threads-compared", command.threads_compared, "1, 2 and 4 threads");
    app.add_option("--save-baseline", command.save, "keep the rows")->expected(0, 1)->default_str(baseline_file);
    app.add_option("--compare", command.compare, "with a stored baseline")->expected(0, 1)->default_str(baseline_file);
    CLI11_PARSE(app, argc, argv);
    command.table = command.scenes.empty() && command.largest_net == 0 && !command.all_fixtures;
    if (!tests::support::has_shared_files()) {
        std::fprintf(stderr, "no folder %s (set FETTLE_SHARED)\n", tests::support::shared_folder().c_str());
        return 3;
    }
    command.references = read_reference_table(FETTLE_SOURCE_DIR "/docs/reference_seconds.tsv");
    command.program.program = program_of_this_build();
    if (command.largest_net > 0) command.program.mesh_dir = tests::support::shared_file("scenes/meshes");
    if (command.all_fixtures) command.run.repeat = 1;
    Runner runner(command);
    std::vector<SceneRow> rows;
    const tests::support::TemporaryFolder folder;
    for (const Job& job : jobs_of(command, folder)) {
        if (command.threads_compared)
            runner.compare_threads(job);
        else
            rows.push_back(runner.run(job));
    }
    if (command.largest_net > 0) print_growth(rows);
    print_table(rows, command.references);
    if (!command.save.empty() && !write_baseline(command.save, rows)) return 4;
    return runner.finish(rows);
}
