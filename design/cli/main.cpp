// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <exception>

#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/version.hpp"
#include "fettle/core/files/nearest_word.hpp"
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

// "fettle optmise x": says what was probably meant, which CLI11 does not.
std::string usage_message(const CLI::ParseError& error, const std::vector<Command>& commands, int argc, char** argv) {
    const std::string otherwise = std::string(error.what()) + "; see fettle --help";
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty() || word[0] == '-') return otherwise;
    std::vector<std::string_view> known{"optimize"};
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.app->get_name());
    known.insert(known.end(), names.begin(), names.end());
    if (std::find(known.begin(), known.end(), word) != known.end()) return otherwise;
    return "there is no command \"" + word + "\"; " + core::files::did_you_mean(word, known);
}

void add_common_options(CLI::App& program, CommonOptions& common) {
    program.set_version_flag("--version", std::string("fettle ") + core::base::version());
    program.add_option("--threads", common.threads, "How many threads (default: all of the machine's); changes no bit of a result")
        ->check(CLI::Range(1, 4096));
    program.add_flag("--json", common.json, "Answer with one JSON object on stdout, and nothing else there");
    program.add_flag("--quiet", common.quiet, "No narration, no progress bars");
    program.add_option("--mesh-dir", common.mesh_dirs, "Look for meshes here too (can be given several times)")->allow_extra_args(false);
}

int run(int argc, char** argv) {
    CLI::App program("fettle: tunes mechanisms of rigid parts under certified clearance", "fettle");
    CommonOptions common;
    add_common_options(program, common);
    const std::vector<Command> commands{add_validate(program, common), add_simulate(program, common), add_clearance(program, common),
                                        add_gradient(program, common), add_optimise(program, common), add_ccd(program)};
    for (const Command& command : commands) command.app->fallthrough();
    program.require_subcommand(1);
    program.footer(
        "Example:  fettle optimise examples/slider_crank/slider_crank.design.json --out out\n"
        "Exit codes: 0 done, requirements certified; 1 a requirement is violated; 2 undecided or not converged;\n"
        "            3 bad input or usage; 4 a fault of this program");
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
        Console console({asks_for_json(argc, argv), false});
        return console.input_errors({{ErrorCode::unsupported, "command line", usage_message(error, commands, argc, argv)}});
    }
    Console console({common.json, common.quiet});
    try {
        std::optional<core::base::ThreadLimit> limit;
        if (common.threads > 0) limit.emplace(common.threads);
        catch_interrupts();
        for (const Command& command : commands) {
            if (command.app->parsed()) return command.run(console);
        }
    } catch (const std::exception& error) {
        return console.internal_error(error.what());
    }
    return console.internal_error("no command ran");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fettle: internal error: %s\n", error.what());
        return exit_internal;
    }
}
