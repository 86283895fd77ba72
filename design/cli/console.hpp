// SPDX-License-Identifier: MIT
/// What the program says, and where: results on stdout (one JSON object with --json, else text), narration and progress bars on stderr.
/// On a terminal progress is a bar with rate and time left; elsewhere, and in the log, a line every ten seconds. Nothing is coloured when
/// NO_COLOR is set or stdout is no terminal.
#pragma once

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "fettle/core/base/result.hpp"
#include "fettle/core/base/types.hpp"

namespace fettle::design::cli {

enum ExitCode {
    exit_done = 0,       ///< done, and every requirement certified
    exit_violated = 1,   ///< a requirement is violated
    exit_undecided = 2,  ///< undecided or not converged
    exit_bad_input = 3,  ///< bad input or usage
    exit_internal = 4    ///< our own fault
};

struct ConsoleOptions {
    bool json = false;
    bool quiet = false;
    std::string log;  ///< file that gets narration and progress too, line by line; empty: none
};

class Console {
public:
    explicit Console(const ConsoleOptions& options);

    bool json() const { return options_.json; }

    /// A line of narration on stderr, unless --quiet.
    void narrate(const std::string& line);
    /// A progress bar on stderr; replaces the one before. `done == of` ends it.
    void progress(const std::string& what, int done, int of);
    void end_progress();

    /// The command's answer: the object with --json, else the text.
    void result(const nlohmann::ordered_json& json, const std::string& text);

    /// Errors in the input. With --json: {"status": "error", "errors": [{code, where, message}]} on stdout; else lines on stderr.
    /// @return exit_bad_input
    int input_errors(const Errors& errors);
    /// The same for a fault of ours. @return exit_internal
    int internal_error(const std::string& message);

    /// "clear" in green and so on, if colours are wanted.
    std::string coloured(const std::string& text, bool good) const;

private:
    using Clock = std::chrono::steady_clock;
    void log(const std::string& line);
    /// ", 35/s, 25 s left"; empty where nothing can be said.
    std::string pace(int done, int of) const;

    ConsoleOptions options_;
    std::shared_ptr<std::FILE> log_;
    Clock::time_point begun_ = Clock::now();
    std::string progress_of_;  ///< what the bar is about
    Clock::time_point progress_begun_, line_written_;
    int first_done_ = 0;
    bool terminal_ = false, colours_ = false, bar_shown_ = false;
    int bar_permille_ = -1;
};

const char* to_string(ErrorCode code);

}  // namespace fettle::design::cli
