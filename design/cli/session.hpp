// SPDX-License-Identifier: MIT
/// What every subcommand has: the common options, the console, interruption.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fettle/design/cli/console.hpp"

namespace CLI {
class App;
}

namespace fettle::design::cli {

struct CommonOptions {
    int threads = 0;  ///< 0: all of the machine's
    bool json = false, quiet = false;
    bool strict = false;  ///< faults of meshes that are warnings else are errors
    std::vector<std::string> mesh_dirs;
};

/// A subcommand: adds itself to the program's options; `run` is called once the command line has been read, and returns the exit code.
struct Command {
    CLI::App* app = nullptr;
    std::function<int(Console&)> run;
};

Command add_validate(CLI::App& program, const CommonOptions& common);
Command add_simulate(CLI::App& program, const CommonOptions& common);
Command add_clearance(CLI::App& program, const CommonOptions& common);
Command add_gradient(CLI::App& program, const CommonOptions& common);
Command add_optimise(CLI::App& program, const CommonOptions& common);
Command add_ccd(CLI::App& program);

/// From now on the first Ctrl-C asks the work to stop with what it has; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace fettle::design::cli
