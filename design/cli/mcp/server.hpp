// SPDX-License-Identifier: MIT
/// The Model Context Protocol (https://modelcontextprotocol.io, revision 2025-06-18) over stdin and stdout: one JSON-RPC 2.0 message a
/// line. Each call of a tool is a process of this program, so that its answer is the command line's, a fault ends no other call, and what
/// is cancelled ends at once. A call that takes longer than it is waited for goes on as a job.
#pragma once

#include <string>
#include <vector>

#include "design/cli/command_line.hpp"

namespace fettle::design::cli::mcp {

struct ServerOptions {
    std::vector<std::string> roots;      ///< folders that are open to the tools; empty: those that the client states, else the current one
    std::vector<std::string> passed_on;  ///< options of the program that every call has: "--allow-programs"
    CommandFacts program;
};

/// Serves until stdin ends, then ends what still runs.
void serve(const ServerOptions& options);

}  // namespace fettle::design::cli::mcp
