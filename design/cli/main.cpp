// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/printed_text.hpp"
#include "core/base/shared_library.hpp"
#include "core/base/stop.hpp"
#include "core/base/version.hpp"
#include "core/files/nearest_word.hpp"
#include "design/answers/answer_json.hpp"
#include "design/answers/output_folder.hpp"
#include "design/cli/command.hpp"
#include "design/cli/inputs.hpp"
#include "design/cli/named_files.hpp"
#include "design/cli/program_memory.hpp"
#include "design/cli/read_files.hpp"

namespace {

using namespace fettle;
using namespace fettle::design::cli;

// Errors of the command line itself are answered before the options have been read.
bool asks_for_json(int argc, char** argv) {
    for (int k = 1; k < argc; ++k) {
        if (std::strcmp(argv[k], "--json") == 0) return true;
    }
    return false;
}

FindingFiles finding_files_in(const std::vector<NamedFile>& named) {
    FindingFiles files;
    for (const auto& [option, file, is_written] : named) {
        if (!is_written) continue;
        (option == "--junit" ? files.junit : option == "--sarif" ? files.sarif : files.markdown) = file;
    }
    return files;
}

// "fettle optmise x": says what was probably meant.
std::string usage_message(const ParseOutcome& parsed, const std::vector<Command>& commands) {
    const std::string help = parsed.command.empty() ? "fettle --help" : "fettle " + parsed.command + " --help";
    if (parsed.no_command.empty()) return parsed.message + "; see " + help;
    std::vector<std::string_view> known;
    for (const Command& command : commands) known.push_back(command.line.name());
    return "there is no command \"" + parsed.no_command + "\"; " + core::files::did_you_mean(parsed.no_command, known);
}

// As it can be typed again: words that a shell would take apart or change are quoted.
std::string typed(int argc, char** argv) {
    std::string text = "fettle";
    for (int k = 1; k < argc; ++k) text += ' ' + design::answers::shell_word(argv[k]);
    return text;
}

void add_common_options(CommandLine program, CommonOptions& common) {
    program.version(std::string("fettle ") + core::base::version());
    program.option("--threads", common.threads, "How many threads (default: all of the machine's); changes no bit of a result")
        .between(1, 4096);
    program.flag("--json", common.json, "Answer with one JSON object on stdout, and nothing else there");
    program.option("--log", common.log, "Write narration and progress to this file too, --quiet or not");
    program.flag("--quiet", common.quiet, "No narration, no progress bars");
    program.flag("--strict", common.strict,
                 "Make errors of mesh faults that would be mended (copies, turned triangles, gaps, ...), and of warnings");
    program.flag("--allow-programs", common.allow_programs, "Run the programs that a scene names to make its parts (such as OpenSCAD)");
    program.option("--scenario", common.scenario, "Of a design: the scenario that is simulated, measured or drawn (default: its first)");
    program.option("--mesh-dir", common.mesh_dirs, "Look for meshes here too (can be given several times)").one_value_each();
}

void add_check_options(CommandLine program, FindingFiles& files) {
    program.option("--junit", files.junit, "Also write the findings as JUnit XML, for the tests of a CI; undecided is a failure");
    program.option("--sarif", files.sarif, "Also write the findings as SARIF 2.1.0, for code scanning");
    program.option("--markdown", files.markdown,
                   "Also write the findings as a table in Markdown (appended, if it is GitHub's job summary)");
    program.flag("--annotations", files.annotations, "Write findings to stderr in the form that GitHub Actions shows beside the files");
}

Checks checks_of(const std::string& command, int exit_code, const Console& console) {
    const CheckOutcome outcomes[] = {CheckOutcome::passed, CheckOutcome::failed, CheckOutcome::undecided};
    return {command, exit_code, exit_code <= exit_undecided ? outcomes[exit_code] : CheckOutcome::fault, console.checks(), console.about()};
}

// Those that something else is, too, are not written.
void keep_apart(FindingFiles& files, const Errors& twice) {
    for (std::string* file : {&files.junit, &files.sarif, &files.markdown})
        if (std::any_of(twice.begin(), twice.end(), [&](const Error& error) { return error.where == *file; })) file->clear();
}

// Writes the findings, where they are wanted, then the answer, which tells what could not be written. A command that tells nothing of its
// own has its end told. @return the exit code
int finish(const FindingFiles& files, const std::string& command, int verdict, Console& console) {
    if (!files.wanted()) {
        console.give_answer();
        return console.exit_code(verdict);
    }
    const int before = console.exit_code(verdict);
    const bool only_remarks = std::all_of(console.checks().begin(), console.checks().end(),
                                          [](const Check& check) { return check.outcome == CheckOutcome::remarked; });
    if (only_remarks)
        console.found(
            {command, checks_of(command, before, console).verdict, command, "ended with exit code " + std::to_string(before), ""});
    console.unwritten(write_finding_files(files, checks_of(command, before, console)));
    console.give_answer();
    const Checks checks = checks_of(command, console.exit_code(verdict), console);
    if (checks.exit_code != before) static_cast<void>(write_finding_files(files, checks));  // no pass; what cannot be written is told
    if (files.annotations) std::fputs(annotation_lines(checks).c_str(), stderr);
    return checks.exit_code;
}

// What a command is about: the first file or folder that it is given and that is there; else the first that it is given.
std::string subject_of(const std::vector<NamedFile>& named) {
    std::string first;
    std::error_code ignored;
    for (const auto& [option, file, is_written] : named) {
        const bool is_input = !is_written && !option.starts_with("-") && !file.starts_with("-");
        if (is_input && std::filesystem::exists(file, ignored)) return file;
        if (is_input && first.empty() && option != "another word") first = file;
    }
    return first;
}

// Nothing is begun.
int refuse(const CommonOptions& common, const std::string& command, const Errors& errors) {
    Console console({common.json, false, {}, true});
    console.set_about(subject_of(common.given.named));
    return finish(common.finding_files, command, console.input_errors(errors), console);
}

// Refuses a command line that cannot be read: the files that it may mean all the same must not stay as an earlier run left them.
int refuse_usage(int argc, char** argv, const std::string& command, const std::string& message) {
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const std::vector<NamedFile> named = named_files_in(words, {"--junit", "--sarif", "--markdown"});
    CommonOptions common;
    common.json = asks_for_json(argc, argv);
    common.given.named = named;
    common.finding_files = finding_files_in(named);
    common.finding_files.annotations = std::find(words.begin(), words.end(), "--annotations") != words.end();
    keep_apart(common.finding_files, named_twice(named));
    static_cast<void>(prepare_finding_files(common.finding_files));  // the command line is what is wrong
    return refuse(common, command, {{ErrorCode::unsupported, "command line", message}});
}

// Those that are named; and of a folder of results what may also be a run's input.
std::vector<NamedFile> written_by(const GivenFiles& given) {
    std::vector<NamedFile> written;
    for (const NamedFile& file : given.named) {
        if (!file.is_written) continue;
        written.push_back(file);
        if (file.option != "--out" || (given.command != "simulate" && given.command != "clearance" && given.command != "optimise"))
            continue;
        written.push_back({file.option, (std::filesystem::path(file.file) / "motion.glb").string(), true});
        if (given.command == "optimise")
            written.push_back({file.option, (std::filesystem::path(file.file) / "design.final.json").string(), true});
    }
    return written;
}

// Those that nothing else is are made ready to be written. @return what is wrong with the others
Errors prepare(CommonOptions& common) {
    Errors errors = named_twice(common.given.named);
    if (errors.empty()) errors = replaced_inputs(written_by(common.given), common.given);
    keep_apart(common.finding_files, errors);
    const auto add = [&](const Errors& found) { errors.insert(errors.end(), found.begin(), found.end()); };
    add(prepare_finding_files(common.finding_files));
    if (!common.log.empty() && errors.empty()) add(fettle::design::answers::try_output_file(common.log));
    return errors;
}

int run_command(const Command& command, Console& console) {
    try {
        return command.run(console);
    } catch (const core::base::MissingLibrary& missing) {
        return console.input_errors({{ErrorCode::file_not_found, "libraries", missing.what()}});
    } catch (const core::base::Stopped&) {
        return console.stopped();
    } catch (const std::bad_alloc&) {
        return console.out_of_memory();
    } catch (const std::exception& error) {
        return console.internal_error(error.what());
    }
}

// By what people want to do.
std::vector<Command> add_commands(CommandLine& program, const CommonOptions& common) {
    std::vector<Command> all;
    const auto add = [&](const char* group, std::vector<Command> commands) {
        for (Command& command : commands) {
            command.line.group(group);
            all.push_back(std::move(command));
        }
    };
    add("Start", {add_new(program), add_shapes(program), add_joints(program), add_quantities(program), add_optimisers(program)});
    add("Check", {add_validate(program, common), add_check(program, common), add_clearance(program, common), add_ranges(program, common),
                  add_features(program, common), add_fit(program, common), add_resize(program, common), add_stretch(program, common),
                  add_check_resolution(program, common), add_tolerance(program, common)});
    add("Measure your printer", {add_coupon(program), add_process(program)});
    add("Simulate and tune",
        {add_simulate(program, common), add_optimise(program, common), add_explore(program, common), add_gradient(program, common)});
    add("Show and export", {studio::add_studio(program, common), add_report(program, common), add_draw(program, common),
                            add_export(program, common), add_import(program, common)});
    add("About the program", {mcp::add_mcp(program, common), add_completion(program), add_manual(program)});
    return all;
}

void tell_missing_folders(const std::vector<std::string>& mesh_dirs, Console& console) {
    std::vector<std::string> warnings;
    std::error_code ignored;
    for (const std::string& folder : mesh_dirs)
        if (!std::filesystem::is_directory(folder, ignored)) warnings.push_back("--mesh-dir " + folder + ": there is no such folder");
    tell_warnings(console, warnings);
}

int run(int argc, char** argv) {
    ProgramLine line("fettle", "fettle: tunes mechanisms of rigid parts under certified clearance");
    CommandLine program = line.options();
    CommonOptions common;
    common.command = typed(argc, argv);
    add_common_options(program, common);
    add_check_options(program, common.finding_files);
    const std::vector<Command> commands = add_commands(program, common);
    program.closing_words(
        "Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out\n"
        "Exit codes: 0 done, requirements met (clearances: certified); 1 a requirement is violated; 2 undecided or not converged;\n"
        "            3 bad input or usage, or output that cannot be written; 4 a fault of this program");
    const ParseOutcome parsed = line.parse(argc, argv);
    if (!parsed.run) {
        if (parsed.exit_code != 0)
            return refuse_usage(argc, argv, parsed.command.empty() ? "fettle" : parsed.command, usage_message(parsed, commands));
        Console console({asks_for_json(argc, argv), false, {}});  // --help, --version
        console.print(parsed.message);
        return console.exit_code(exit_done);
    }
    const auto command = std::find_if(commands.begin(), commands.end(), [](const Command& each) { return each.line.is_chosen(); });
    if (command == commands.end()) return Console({common.json, false, {}}).internal_error("no command ran");
    if (command->refused) {
        if (const Errors errors = command->refused(); !errors.empty()) return Console({common.json, false, {}}).input_errors(errors);
    }
    std::vector<GivenValue> given = program.given();
    const std::vector<GivenValue> own = command->line.given();
    given.insert(given.end(), own.begin(), own.end());
    common.given = {command->line.name(), named_files_of(command->line.name(), given), common.mesh_dirs};
    if (const Errors errors = prepare(common); !errors.empty()) return refuse(common, command->line.name(), errors);
    Console console({common.json, common.quiet, common.log, common.finding_files.wanted()});
    console.set_about(subject_of(common.given.named));
    std::optional<core::base::ThreadLimit> limit;
    if (common.threads > 0) limit.emplace(common.threads);
    catch_interrupts();
    tell_missing_folders(common.mesh_dirs, console);
    return finish(common.finding_files, command->line.name(), run_command(*command, console), console);
}

// For libraries of linear algebra, which are loaded later; what the user has set holds.
// Ours are the threads: theirs take tens of megabytes each, and where that cannot be had they wait for ever.
// OpenBLAS goes by the processor's model, and takes one that is newer than itself for the oldest of all; by what the processor can do its
// answers are the same bits on all that can do the same.
void prepare_linear_algebra() {
    for (const char* name : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS"}) setenv(name, "1", 0);
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
    else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        setenv("OPENBLAS_CORETYPE", "Haswell", 0);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    prepare_linear_algebra();
    expect_failed_writes();
    keep_freed_memory();
    expect_out_of_memory(asks_for_json(argc, argv));
    try {
        return fettle::design::cli::ended(run(argc, argv));
    } catch (const std::bad_alloc&) {
        end_out_of_memory();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fettle: internal error: %s\n", core::base::printed(error.what()).c_str());
        return fettle::design::cli::ended(exit_internal);
    }
}
