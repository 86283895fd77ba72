// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>

#include "fettle/core/base/limits.hpp"
#include "fettle/core/base/parallel.hpp"
#include "fettle/core/base/version.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/core/files/text_lines.hpp"
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

// "Value five not in range 0 to 179769...": what is allowed, in words.
std::string readable(const std::string& what) {
    const std::string_view begin = ": Value ", middle = " not in range ", between = " to ";
    const std::size_t value = what.find(begin), range = what.find(middle), to = what.find(between, range);
    if (value == std::string::npos || range == std::string::npos || to == std::string::npos || range < value + begin.size()) return what;
    const auto plain = [](std::string number) {  // "0.000000" -> "0"
        if (number.find('.') != std::string::npos) number.erase(number.find_last_not_of('0') + 1);
        if (!number.empty() && number.back() == '.') number.pop_back();
        return number;
    };
    const std::string low = plain(what.substr(range + middle.size(), to - range - middle.size())),
                      high = plain(what.substr(to + between.size()));
    const std::string found = what.substr(value + begin.size(), range - value - begin.size());
    return what.substr(0, value) + ": `" + found + "` is not a number " +
           (high.size() > 30 ? "of at least " + low : "from " + low + " to " + high);
}

// "fettle optmise x": says what was probably meant, which CLI11 does not.
std::string usage_message(const CLI::ParseError& error, const std::vector<Command>& commands, int argc, char** argv) {
    const std::string otherwise = readable(error.what()) + "; see fettle --help";
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty() || word[0] == '-') return otherwise;
    std::vector<std::string_view> known{"optimize"};
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.app->get_name());
    known.insert(known.end(), names.begin(), names.end());
    if (std::find(known.begin(), known.end(), word) != known.end()) return otherwise;
    return "there is no command \"" + word + "\"; " + core::files::did_you_mean(word, known);
}

// Numbers that no option can mean, whatever each one's own range: NaN, and what would overflow in the first product.
Errors unusable_numbers(const CLI::App& app) {
    Errors errors;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& word : option->results()) {
            const auto number = core::files::parsed_number(word);
            if (!number || core::base::is_usable_number(*number)) continue;
            errors.push_back({std::isfinite(*number) ? ErrorCode::out_of_range : ErrorCode::not_finite, option->get_name(),
                              word + " is out of range: a number of at most 1e30 in absolute value is wanted"});
        }
    }
    return errors;
}

void add_common_options(CLI::App& program, CommonOptions& common) {
    program.set_version_flag("--version", std::string("fettle ") + core::base::version());
    program.add_option("--threads", common.threads, "How many threads (default: all of the machine's); changes no bit of a result")
        ->check(CLI::Range(1, 4096));
    program.add_flag("--json", common.json, "Answer with one JSON object on stdout, and nothing else there");
    program.add_flag("--quiet", common.quiet, "No narration, no progress bars");
    program.add_flag("--strict", common.strict,
                     "Meshes: what is mended or a warning else (copies, turned triangles, gaps, ...) is an error");
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
            if (!command.app->parsed()) continue;
            const Errors errors = unusable_numbers(*command.app);
            return errors.empty() ? command.run(console) : console.input_errors(errors);
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
