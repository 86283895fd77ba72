// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/shared_library.hpp"
#include "fettle/core/base/version.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/cli/output_folder.hpp"
#include "fettle/design/cli/outputs_apart.hpp"
#include "fettle/design/cli/program_memory.hpp"
#include "fettle/design/cli/session.hpp"

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

// "fettle optmise x": says what was probably meant.
std::string usage_message(const ParseOutcome& parsed, const std::vector<Command>& commands) {
    const std::string help = parsed.command.empty() ? "fettle --help" : "fettle " + parsed.command + " --help";
    if (parsed.word.empty()) return parsed.message + "; see " + help;
    std::vector<std::string_view> known;
    for (const Command& command : commands) known.push_back(command.line.name());
    return "there is no command \"" + parsed.word + "\"; " + core::files::did_you_mean(parsed.word, known);
}

// As it can be typed again: words that a shell would take apart or change are quoted.
std::string typed(int argc, char** argv) {
    std::string text = "fettle";
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        const bool plain = !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]{}()<>|&;#~!") == std::string::npos;
        text += ' ';
        if (plain) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += '\'';
    }
    return text;
}

void add_common_options(CommandLine program, CommonOptions& common) {
    program.version(std::string("fettle ") + core::base::version());
    program.option("--threads", common.threads, "How many threads (default: all of the machine's); changes no bit of a result")
        .between(1, 4096);
    program.flag("--json", common.json, "Answer with one JSON object on stdout, and nothing else there");
    program.option("--log", common.log, "Write narration and progress to this file too, --quiet or not");
    program.flag("--quiet", common.quiet, "No narration, no progress bars");
    program.flag("--strict", common.strict, "Meshes: what is mended or a warning else (copies, turned triangles, gaps, ...) is an error");
    program.flag("--allow-programs", common.allow_programs, "Run the programs that a scene names to make its parts (such as OpenSCAD)");
    program.option("--mesh-dir", common.mesh_dirs, "Look for meshes here too (can be given several times)").one_value_each();
}

void add_check_options(CommandLine program, CheckFiles& files) {
    program.option("--junit", files.junit, "Write what was found as JUnit XML too, for the tests of a CI; undecided is a failure");
    program.option("--sarif", files.sarif, "Write what was found as SARIF 2.1.0 too, for code scanning");
    program.option("--markdown", files.markdown, "Write what was found as a table in Markdown too (of GitHub's job summary: added to it)");
    program.flag("--annotations", files.annotations, "Tell what was found on stderr as GitHub Actions shows it beside the files");
}

// Folders to look in that are none would be passed over without a word.
Errors check_mesh_dirs(const std::vector<std::string>& folders) {
    Errors errors;
    std::error_code ignored;
    for (const std::string& folder : folders)
        if (!std::filesystem::is_directory(folder, ignored))
            errors.push_back({ErrorCode::file_not_found, "--mesh-dir", "there is no folder " + folder});
    return errors;
}

// What was found, where it is wanted. Of a command that tells nothing of its own its end is told. @return the exit code
int leave_check_files(const CheckFiles& files, const std::string& command, int exit_code, Console& console) {
    if (!files.wanted()) return exit_code;
    const CheckOutcome outcomes[] = {CheckOutcome::passed, CheckOutcome::failed, CheckOutcome::undecided};
    const CheckOutcome verdict = exit_code <= exit_undecided ? outcomes[exit_code] : CheckOutcome::fault;
    if (console.checks().empty()) console.found({command, verdict, command, "ended with exit code " + std::to_string(exit_code), ""});
    const Errors errors = write_check_files(files, {command, exit_code, verdict, console.checks()});
    if (errors.empty()) return exit_code;
    console.input_errors(errors);
    return exit_code == exit_done ? static_cast<int>(exit_bad_input) : exit_code;
}

int run_command(const Command& command, Console& console) {
    try {
        return console.exit_code(command.run(console));
    } catch (const core::base::MissingLibrary& missing) {
        return console.input_errors({{ErrorCode::file_not_found, "libraries", missing.what()}});
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
    add("Check what there is", {add_validate(program, common), add_clearance(program, common)});
    add("Move and tune",
        {add_simulate(program, common), add_optimise(program, common), add_explore(program, common), add_gradient(program, common)});
    add("See and pass on",
        {add_report(program, common), add_draw(program, common), add_export(program, common), add_import(program, common)});
    add("About the program", {add_ccd(program), add_completion(program), add_manual(program)});
    return all;
}

int run(int argc, char** argv) {
    ProgramLine line("fettle", "fettle: tunes mechanisms of rigid parts under certified clearance");
    CommandLine program = line.options();
    CommonOptions common;
    common.command = typed(argc, argv);
    add_common_options(program, common);
    add_check_options(program, common.check_files);
    const std::vector<Command> commands = add_commands(program, common);
    program.closing_words(
        "Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out\n"
        "Exit codes: 0 done, requirements certified; 1 a requirement is violated; 2 undecided or not converged;\n"
        "            3 bad input or usage, or output that cannot be written; 4 a fault of this program");
    const ParseOutcome parsed = line.parse(argc, argv);
    if (!parsed.run) {
        Console console({asks_for_json(argc, argv), false, {}});
        if (parsed.exit_code == 0) {  // --help, --version
            console.print(parsed.message);
            return console.exit_code(exit_done);
        }
        return console.input_errors({{ErrorCode::unsupported, "command line", usage_message(parsed, commands)}});
    }
    for (const Command& command : commands) {
        if (!command.line.is_chosen()) continue;
        std::vector<GivenValue> given = program.given();
        for (GivenValue& value : command.line.given()) given.push_back(std::move(value));
        Errors errors = command.refused ? command.refused() : Errors();
        if (errors.empty()) errors = check_mesh_dirs(common.mesh_dirs);
        if (errors.empty()) errors = check_outputs_apart(command, given, common);
        if (!errors.empty()) return Console({common.json, false, {}}).input_errors(errors);
    }
    if (!common.log.empty()) {
        const Errors errors = try_output_file(common.log);
        if (!errors.empty()) return Console({common.json, false, {}}).input_errors(errors);
    }
    if (const Errors errors = prepare_check_files(common.check_files); !errors.empty())
        return Console({common.json, false, {}}).input_errors(errors);
    Console console({common.json, common.quiet, common.log});
    std::optional<core::base::ThreadLimit> limit;
    if (common.threads > 0) limit.emplace(common.threads);
    catch_interrupts();
    for (const Command& command : commands) {
        if (!command.line.is_chosen()) continue;
        return leave_check_files(common.check_files, command.line.name(), run_command(command, console), console);
    }
    return console.internal_error("no command ran");
}

}  // namespace

int main(int argc, char** argv) {
    expect_failed_writes();
    keep_freed_memory();
    expect_out_of_memory(asks_for_json(argc, argv));
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        end_out_of_memory();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fettle: internal error: %s\n", error.what());
        return exit_internal;
    }
}
