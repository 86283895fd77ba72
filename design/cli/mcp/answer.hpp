// SPDX-License-Identifier: MIT
/// What a tool answers: the command's own answer, begun by a verdict in one word and a sentence, and short enough to be read by an agent.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "design/cli/mcp/tools.hpp"

namespace fettle::design::cli::mcp {

/// How a command ended.
struct Ended {
    int exit_code = 0;
    std::string out;       ///< its stdout: one JSON object
    std::string findings;  ///< what it found, as a table (--markdown)
    std::string error;     ///< the end of its stderr
    std::string typed;     ///< what a person would have typed
};

/// The result of a call (Model Context Protocol, CallToolResult): `structuredContent` has verdict, sentence, command and answer, `content`
/// the findings and the same as text.
/// @param whole   In: null. Out: the whole answer, where `answer` is not all of it.
/// @param number  What the whole answer will be called.
Json result_of(const Tool& tool, const Ended& ended, const std::string& number, Json& whole);

/// A call that was not made: the reasons, one a line.
Json refusal(const Errors& errors);
/// A call that goes on. @param doing  what it reported last
Json still_running(const std::string& job, const std::string& typed, const std::string& doing);
/// Text alone.
Json text_result(const std::string& sentence, const std::string& text);

/// A part of an answer, in pages: `count` from `from` on of a list, an object's keys with their sizes where it is long.
/// Errors: there is no such part.
Result<Json> part_of(const Json& answer, const std::string& pointer, std::size_t from, std::size_t count);

}  // namespace fettle::design::cli::mcp
