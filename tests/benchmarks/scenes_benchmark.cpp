// SPDX-License-Identifier: MIT
// How fast, and how soundly, do the paper's scenes run? One JSON row per scene on stdout, then a summary, a table on stderr. Single thread,
// each scene in a process of its own; CPU time of the thread, because machines are shared. Every run that is timed is checked: status,
// finite poses, repeated runs of the same bits, no intersection by exact predicates at nodes and between, peak memory. Exit code 1 if a
// check fails.
//
//   scenes_benchmark                              the table (scene_table.hpp), compared with the reference program
//   scenes_benchmark pendulum/pendulum a.json     these, by name under ../shared/scenes/fixtures or by path; --steps N
//   scenes_benchmark --all-fixtures --seconds 60  every scene there, to its own end or that much CPU time: hunts stalls and NaN
//   scenes_benchmark --net 16                     cost per contact of n x n chain nets, n = 4, 8, .. 16
//   scenes_benchmark --two-threads SCENE ...      the same bits at 1 and 2 threads? how much faster?
//   scenes_benchmark --save-baseline[=FILE], --compare[=FILE]    FILE: tests/benchmarks/scenes_baseline.json unless given
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "fettle/core/files/atomic_file.hpp"
#include "fettle/tests/benchmarks/scene_row.hpp"
#include "fettle/tests/benchmarks/scene_table.hpp"
#include "fettle/tests/support/chain_net.hpp"
#include "fettle/tests/support/shared_files.hpp"

using namespace fettle;
using namespace fettle::tests::benchmarks;
namespace fs = std::filesystem;

namespace {

struct Command {
    std::vector<std::string> scenes;
    std::vector<int> nets;
    int largest_net = 0;
    bool all_fixtures = false, two_threads = false, table = false;
    std::string save, compare;
    RunOptions run;
};

/// What to run: a name for the rows, the scene's text, where meshes are looked for from.
struct Job {
    std::string name, text, path;
    int steps = -1;
};

/// A geometric mean and the worst of a list of ratios, larger is better.
struct Ratios {
    double log_sum = 0, worst = INFINITY;
    std::string worst_scene;
    int count = 0;
    void add(double ratio, const std::string& scene) {
        log_sum += std::log(ratio);
        ++count;
        if (ratio < worst) worst = ratio, worst_scene = scene;
    }
    std::string json(const char* name) const {
        char text[256];
        std::snprintf(text, sizeof text, "\"%s\": {\"geometric_mean\": %.4g, \"worst\": %.4g, \"worst_scene\": \"%s\", \"scenes\": %d}",
                      name, std::exp(log_sum / count), worst, worst_scene.c_str(), count);
        return text;
    }
};

fs::path fixtures() { return tests::support::shared_folder() / "scenes/fixtures"; }

const TableScene* in_table(const std::string& name) {
    const auto at = std::find_if(scene_table.begin(), scene_table.end(), [&](const TableScene& s) { return name == s.name; });
    return at == scene_table.end() ? nullptr : &*at;
}

Job file_job(const std::string& given, int steps) {
    const fs::path under = fixtures() / (given + ".json");
    const fs::path path = fs::exists(under) ? under : fs::path(given);
    const auto text = core::files::read_file(path);
    if (!text) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), text.errors().front().message.c_str());
        std::exit(3);
    }
    return {given, *text, path.string(), steps};
}

Job net_job(int n, int steps) {
    return {"net-" + std::to_string(n) + "x" + std::to_string(n), tests::support::chain_net_scene(n),
            (fixtures() / "chain/chain-net/generated.json").string(), steps};
}

std::vector<Job> jobs_of(const Command& command) {
    std::vector<Job> jobs;
    const int steps = command.run.steps;
    for (int n = 4; n <= command.largest_net; n *= 2) jobs.push_back(net_job(n, steps < 0 ? 63 : steps));
    for (const std::string& name : command.scenes) {
        const TableScene* entry = in_table(name);
        jobs.push_back(file_job(name, steps < 0 && entry != nullptr ? entry->steps : steps));
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
        for (const TableScene& scene : scene_table)
            jobs.push_back(file_job(scene.name, steps < 0 ? scene.steps : std::min(steps, scene.steps)));
    return jobs;
}

std::string member(const char* name, double value) {
    char text[96];
    std::snprintf(text, sizeof text, "\"%s\": %.5g", name, value);
    return text;
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

    SceneRow run(const Job& job, int threads = 1) {
        RunOptions options = command_.run;
        options.steps = job.steps;
        options.threads = threads;
        const SceneRow row = run_apart(job.name, job.text, job.path, options);
        const bool over_memory = row.peak_memory_bytes > row.memory_limit_bytes();
        if (row.status != "ok" || !row.is_sound() || over_memory) ++failures_;
        std::printf("%s\n", to_json(row, comparisons(row, threads)).c_str());
        std::fflush(stdout);
        return row;
    }

    void two_threads(const Job& job) {
        const SceneRow one = run(job, 1), two = run(job, 2);
        const bool same = one.bits == two.bits;
        if (!same) ++failures_;
        if (one.status != "ok" || two.status != "ok") return;
        std::printf("{\"two_threads\": \"%s\", \"triangles\": %ld, \"same_bits\": %s, %s, %s, %s}\n", job.name.c_str(), one.triangles,
                    same ? "true" : "false", member("wall_seconds_1", one.wall_seconds).c_str(),
                    member("wall_seconds_2", two.wall_seconds).c_str(), member("speedup", one.wall_seconds / two.wall_seconds).c_str());
    }

    int finish() const {
        std::string text = "{\"summary\": true, \"failures\": " + std::to_string(failures_);
        if (against_reference_.count > 0) text += ", " + against_reference_.json("against_reference");
        if (against_baseline_.count > 0) text += ", " + against_baseline_.json("against_baseline");
        std::printf("%s}\n", text.c_str());
        return failures_ > 0 ? 1 : 0;
    }

private:
    std::string comparisons(const SceneRow& row, int threads) {
        std::string text = "\"threads\": " + std::to_string(threads);
        const double ours = row.seconds_per_step();
        if (row.contacts > 0) text += ", " + member("microseconds_per_contact", 1e6 * row.cpu_seconds / static_cast<double>(row.contacts));
        if (const TableScene* entry = in_table(row.scene)) {
            text += ", " + member("reference_seconds_per_step", entry->reference_seconds) + ", " + member("goal", entry->goal_seconds);
            if (ours > 0) {
                text += ", " + member("reference_ratio", entry->reference_seconds / ours);
                if (threads == 1) against_reference_.add(entry->reference_seconds / ours, row.scene);
            }
        }
        const SceneRow* before = find_row(baseline_, row.scene);
        if (before != nullptr && ours > 0 && before->seconds_per_step() > 0) {
            const double ratio = before->seconds_per_step() / ours;
            text += ", " + member("baseline_seconds_per_step", before->seconds_per_step()) + ", " + member("baseline_ratio", ratio);
            if (before->steps != row.steps) text += ", \"baseline_steps\": " + std::to_string(before->steps);
            if (threads == 1) against_baseline_.add(ratio, row.scene);
        }
        return text;
    }

    const Command& command_;
    std::vector<SceneRow> baseline_;
    Ratios against_reference_, against_baseline_;
    int failures_ = 0;
};

void print_net_growth(const std::vector<SceneRow>& rows) {
    const auto per_contact = [](const SceneRow& row) { return row.cpu_seconds / static_cast<double>(row.contacts); };
    for (const SceneRow& row : rows)
        if (row.contacts > 0 && rows.front().contacts > 0)
            std::printf("{\"net\": \"%s\", \"contacts_per_step\": %.5g, \"microseconds_per_contact\": %.5g, \"growth\": %.4g}\n",
                        row.scene.c_str(), static_cast<double>(row.contacts) / row.steps, 1e6 * per_contact(row),
                        per_contact(row) / per_contact(rows.front()));
}

/// The same in brief, for people, on stderr.
void print_table(const std::vector<SceneRow>& rows) {
    std::fprintf(stderr,
                 "| scene | status | steps | Newton per step | reference, s per step | ours | goal | times as fast | peak MB | least "
                 "distance, m |\n");
    std::fprintf(stderr, "|---|---|---|---|---|---|---|---|---|---|\n");
    for (const SceneRow& row : rows) {
        const double ours = row.seconds_per_step(), newton = row.steps > 0 ? static_cast<double>(row.newton_iterations) / row.steps : 0;
        std::fprintf(stderr, "| %s | %s%s | %d | %.2f ", row.scene.c_str(), row.status.c_str(), row.is_sound() ? "" : ", UNSOUND",
                     row.steps, newton);
        if (const TableScene* entry = in_table(row.scene))
            std::fprintf(stderr, "| %.4g | %.3g | %.3g | %.0f ", entry->reference_seconds, ours, entry->goal_seconds,
                         entry->reference_seconds / ours);
        else
            std::fprintf(stderr, "| | %.3g | | ", ours);
        std::fprintf(stderr, "| %.1f | %.3g |\n", row.peak_memory_bytes / 1e6, row.minimum_distance);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string baseline_file = FETTLE_SOURCE_DIR "/tests/benchmarks/scenes_baseline.json";
    Command command;
    CLI::App app("Runs, times and checks scenes; prints JSON rows.");
    app.add_option("scenes", command.scenes, "names under ../shared/scenes/fixtures, or files");
    app.add_option("--steps", command.run.steps, "time steps; default the table's, else the scene's own");
    app.add_option("--seconds", command.run.seconds, "CPU time per scene")->capture_default_str();
    app.add_option("--check-seconds", command.run.check_seconds, "CPU time for looking for intersections")->capture_default_str();
    app.add_option("--instants", command.run.instants_between, "looked at between two nodes")->capture_default_str();
    app.add_option("--repeat", command.run.repeat, "short runs up to so often")->capture_default_str();
    app.add_option("--net", command.largest_net, "chain nets 4x4, 8x8, ... up to this size");
    app.add_flag("--all-fixtures", command.all_fixtures, "every scene, to its own end");
    app.add_flag("--two-threads", command.two_threads, "compare 1 and 2 threads");
    app.add_option("--save-baseline", command.save, "keep the rows")->expected(0, 1)->default_str(baseline_file);
    app.add_option("--compare", command.compare, "with a stored baseline")->expected(0, 1)->default_str(baseline_file);
    CLI11_PARSE(app, argc, argv);
    command.table = command.scenes.empty() && command.largest_net == 0 && !command.all_fixtures;
    if (!tests::support::has_shared_files()) {
        std::fprintf(stderr, "no folder %s (set FETTLE_SHARED)\n", tests::support::shared_folder().c_str());
        return 3;
    }
    if (command.all_fixtures) command.run.repeat = 1;
    Runner runner(command);
    std::vector<SceneRow> rows;
    for (const Job& job : jobs_of(command)) {
        if (command.two_threads)
            runner.two_threads(job);
        else
            rows.push_back(runner.run(job));
    }
    if (command.largest_net > 0 && !command.two_threads) print_net_growth(rows);
    print_table(rows);
    if (!command.save.empty() && !write_baseline(command.save, rows)) return 4;
    return runner.finish();
}
