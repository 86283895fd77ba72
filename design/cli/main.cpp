// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/shared_library.hpp"
#include "fettle/core/base/version.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/cli/output_folder.hpp"
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
std::string usage_message(const std::string& fault, const std::vector<Command>& commands, int argc, char** argv) {
    const std::string otherwise = fault + "; see fettle --help";
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty() || word[0] == '-') return otherwise;
    std::vector<std::string_view> known{"optimize"};
    for (const Command& command : commands) known.push_back(command.line.name());
    if (std::find(known.begin(), known.end(), word) != known.end()) return otherwise;
    return "there is no command \"" + word + "\"; " + core::files::did_you_mean(word, known);
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
    const std::vector<Command> commands = add_commands(program, common);
    program.closing_words(
        "Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out\n"
        "Exit codes: 0 done, requirements certified; 1 a requirement is violated; 2 undecided or not converged;\n"
        "            3 bad input or usage; 4 a fault of this program");
    const ParseOutcome parsed = line.parse(argc, argv);
    if (!parsed.run) {
        if (parsed.message.empty()) return parsed.exit_code;  // --help, --version
        Console console({asks_for_json(argc, argv), false, {}});
        return console.input_errors({{ErrorCode::unsupported, "command line", usage_message(parsed.message, commands, argc, argv)}});
    }
    if (!common.log.empty()) {
        const Errors errors = try_output_file(common.log);
        if (!errors.empty()) return Console({common.json, false, {}}).input_errors(errors);
    }
    Console console({common.json, common.quiet, common.log});
    try {
        std::optional<core::base::ThreadLimit> limit;
        if (common.threads > 0) limit.emplace(common.threads);
        catch_interrupts();
        for (const Command& command : commands) {
            if (command.line.is_chosen()) return command.run(console);
        }
    } catch (const core::base::MissingLibrary& missing) {
        return console.input_errors({{ErrorCode::file_not_found, "libraries", missing.what()}});
    } catch (const std::exception& error) {
        return console.internal_error(error.what());
    }
    return console.internal_error("no command ran");
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fettle: internal error: %s\n", error.what());
        return exit_internal;
    }
}
