// SPDX-License-Identifier: MIT
/// What every subcommand has: the common options, the console, interruption.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/cli/command_line.hpp"
#include "design/cli/console.hpp"
#include "design/cli/finding_files.hpp"
#include "design/cli/named_files.hpp"

namespace fettle::design::cli {

struct CommonOptions {
    int threads = 0;  ///< 0: all of the machine's
    bool json = false, quiet = false;
    bool strict = false;  ///< faults of meshes that are warnings else are errors
    std::vector<std::string> mesh_dirs;
    std::string scenario;         ///< of a design: which is meant; empty: the first
    std::string log;              ///< file for narration and progress; empty: none
    std::string command;          ///< what was typed, for those who read its results
    FindingFiles finding_files;   ///< what was found, for those who show it beside a project
    GivenFiles given;             ///< for outputs whose names only the work shows: replaced_inputs()
    bool allow_programs = false;  ///< parts of a scene may be made by the programs that it names
};

/// A subcommand: adds itself to the program's options; `run` is called once the command line has been read, and returns the exit code.
/// `refused`, if there is one, says which of the common options were given that it does not take, before any file is touched.
struct Command {
    CommandLine line;
    std::function<int(Console&)> run;
    std::function<Errors()> refused = {};
};

Command add_check_resolution(CommandLine& program, const CommonOptions& common);
Command add_clearance(CommandLine& program, const CommonOptions& common);
Command add_completion(CommandLine& program);
Command add_check(CommandLine& program, const CommonOptions& common);
Command add_coupon(CommandLine& program);
Command add_draw(CommandLine& program, const CommonOptions& common);
Command add_export(CommandLine& program, const CommonOptions& common);
Command add_features(CommandLine& program, const CommonOptions& common);
Command add_fit(CommandLine& program, const CommonOptions& common);
Command add_import(CommandLine& program, const CommonOptions& common);
Command add_joints(CommandLine& program);
Command add_manual(CommandLine& program);
namespace mcp {
Command add_mcp(CommandLine& program, const CommonOptions& common);
}
namespace studio {
Command add_studio(CommandLine& program, const CommonOptions& common);
}
Command add_new(CommandLine& program);
Command add_optimisers(CommandLine& program);
Command add_process(CommandLine& program);
Command add_quantities(CommandLine& program);
Command add_resize(CommandLine& program, const CommonOptions& common);
Command add_shapes(CommandLine& program);
Command add_stretch(CommandLine& program, const CommonOptions& common);
Command add_validate(CommandLine& program, const CommonOptions& common);
Command add_simulate(CommandLine& program, const CommonOptions& common);
Command add_gradient(CommandLine& program, const CommonOptions& common);
Command add_optimise(CommandLine& program, const CommonOptions& common);
Command add_ranges(CommandLine& program, const CommonOptions& common);
Command add_report(CommandLine& program, const CommonOptions& common);
Command add_explore(CommandLine& program, const CommonOptions& common);
Command add_tolerance(CommandLine& program, const CommonOptions& common);

/// From now on the first Ctrl-C asks the work to stop with what it has; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace fettle::design::cli
