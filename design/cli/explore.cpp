// SPDX-License-Identifier: MIT
/// `fettle explore`: hands over to the Python package (design/python/fettle/exploration.py), which has the worker processes and Dask.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "fettle/design/cli/session.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;

struct ExploreOptions {
    std::string design, out, dask;
    std::vector<std::string> sweeps;
    int samples = 0, starts = 0, seed = 1;
    std::optional<int> workers;
};

// -P: the current folder, which may be anyone's, is no place of modules; nor is it for the processes that Python starts.
std::vector<std::string> python_words(const ExploreOptions& options, const CommonOptions& common) {
    std::vector<std::string> words{
        "-P", "-m", "fettle", "explore", options.design, "--out", options.out, "--seed", std::to_string(options.seed)};
    for (const std::string& sweep : options.sweeps) words.insert(words.end(), {"--sweep", sweep});
    const auto add = [&](const char* name, const std::string& value) { words.insert(words.end(), {name, value}); };
    if (options.samples > 0) add("--samples", std::to_string(options.samples));
    if (options.starts > 0) add("--starts", std::to_string(options.starts));
    if (options.workers) add("--workers", std::to_string(*options.workers));
    if (!options.dask.empty()) add("--dask", options.dask);
    if (common.allow_programs) words.emplace_back("--allow-programs");
    if (common.json) words.emplace_back("--json");
    if (common.quiet) words.emplace_back("--quiet");
    return words;
}

// Python's side does nothing with them: none is dropped in silence.
Errors refused_options(const CommonOptions& common) {
    const FindingFiles& files = common.finding_files;
    const std::pair<const char*, bool> given[] = {
        {"--threads", common.threads > 0},         {"--log", !common.log.empty()},       {"--strict", common.strict},
        {"--mesh-dir", !common.mesh_dirs.empty()}, {"--junit", !files.junit.empty()},    {"--sarif", !files.sarif.empty()},
        {"--markdown", !files.markdown.empty()},   {"--annotations", files.annotations},
    };
    Errors errors;
    for (const auto& [option, is_given] : given) {
        if (!is_given) continue;
        const std::string instead = std::string_view(option) == "--threads" ? "; --workers says how many processes work at once" : "";
        errors.push_back({ErrorCode::unsupported, "command line", std::string("explore does not take ") + option + instead});
    }
    return errors;
}

// Where the package lies beside this program: in the build tree, or installed with it.
std::string package_path(const fs::path& program) {
    for (const char* place : {"../python", "../lib/python3/dist-packages"}) {
        const fs::path folder = program.parent_path() / place;
        if (fs::exists(folder / "fettle" / "__init__.py")) return fs::weakly_canonical(folder).string();
    }
    return {};
}

// The package, and what PYTHONPATH says. An entry of it that is empty or relative is the current folder, or lies in it: it is left out.
std::string module_path(const fs::path& program) {
    std::string path = package_path(program);
    const char* given = std::getenv("PYTHONPATH");
    std::istringstream entries(given == nullptr ? "" : given);
    for (std::string entry; std::getline(entries, entry, ':');)
        if (fs::path(entry).is_absolute()) path += (path.empty() ? "" : ":") + entry;
    return path;
}

// Ctrl-C and SIGTERM wait until Python's side has what answers them (fettle/__main__.py): while it starts they would be a traceback.
void hold_back_interrupts() {
    sigset_t interrupts;
    sigemptyset(&interrupts);
    sigaddset(&interrupts, SIGINT);
    sigaddset(&interrupts, SIGTERM);
    sigprocmask(SIG_BLOCK, &interrupts, nullptr);
    if (interrupted()) raise(SIGINT);
}

// Only returns where there is no Python.
Error become_python(const ExploreOptions& options, const CommonOptions& common) {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    setenv("PYTHONPATH", module_path(program).c_str(), 1);
    hold_back_interrupts();
    std::vector<std::string> words = python_words(options, common);
    std::vector<std::string> interpreters{(program.parent_path() / "python3").string(), "/usr/bin/python3", "python3"};
    for (std::string& interpreter : interpreters) {
        std::vector<char*> pointers{interpreter.data()};
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execvp(pointers.front(), pointers.data());
    }
    return {ErrorCode::file_not_found, "python3",
            "exploring takes the Python package: Debian's python3 and python3-numpy, and `pip install .`"};
}

}  // namespace

Command add_explore(CommandLine& program, const CommonOptions& common) {
    auto options = std::make_shared<ExploreOptions>();
    CommandLine line = program.command("explore", "Evaluates many designs, or optimises from many starts, in parallel");
    line.option("DESIGN", options->design, "Design file").required();
    line.option("--out", options->out, "File of the results, a line each; an exploration that is there goes on").required();
    line.option("--sweep", options->sweeps, "NAME=COUNT between its bounds, or NAME=LOW:HIGH:COUNT in its unit; all combinations")
        .one_value_each();
    line.option("--samples", options->samples, "How many designs to draw from the bounds").at_least(0);
    line.option("--starts", options->starts, "How many runs of the optimiser").at_least(0);
    line.option("--seed", options->seed, "Seed of samples and starts").at_least(0);
    line.option("--workers", options->workers, "Worker processes (default: the machine's processors)").at_least(1);
    line.option("--dask", options->dask,
                "Address of a running Dask scheduler, whose workers are used instead; it can run code here: one that you trust");
    line.closing_words("Example:  fettle explore hinge.design.json --out sweep.jsonl --sweep pin_radius=10 --sweep wall=1.6:3:8");
    return {line, [options, &common](Console& console) { return console.input_errors({become_python(*options, common)}); },
            [&common] { return refused_options(common); }};
}

}  // namespace fettle::design::cli
