// SPDX-License-Identifier: MIT
/// The tools that agents are offered: each is a command of the program, with the options of it that are of use there. Schemas and
/// descriptions are made from what the command says of itself.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "design/cli/command_line.hpp"
#include "design/cli/mcp/roots.hpp"

namespace fettle::design::cli::mcp {

using Json = nlohmann::ordered_json;

struct Tool {
    const char* name;
    const char* title;
    const char* command;                   ///< of the program; empty: none, the server answers itself
    std::vector<const char*> options;      ///< those of the command that are offered: "FILE", "--minimum"
    const char* about;                     ///< what it does beyond the command's description: cost, and how its answer is meant
    bool writes;                           ///< the annotations: files may be written, also in place of others
    std::vector<const char*> needed = {};  ///< options that the command could do without, and a tool not
};

const std::vector<Tool>& tools();
/// Null: there is none of that name.
const Tool* find_tool(const std::string& name);

/// As `tools/list` has them. @param program  All commands' facts.
Json tool_list(const CommandFacts& program);

/// The words of the command line that a call stands for, without the program's name: paths are absolute and below a root.
/// Errors: an argument that is not offered, or of another type; a path outside.
Result<std::vector<std::string>> words_of(const Tool& tool, const CommandFacts& program, const Json& arguments, const Roots& roots);

/// How long a call is waited for [s]: the argument `wait_seconds`, which each tool has. Errors: it is no number from 0 to 600.
Result<double> seconds_to_wait(const Json& arguments);

}  // namespace fettle::design::cli::mcp
