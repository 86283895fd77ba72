// SPDX-License-Identifier: MIT
/// What the program says, and where: results on stdout (one JSON object with --json, else text), narration and progress bars on stderr.
/// On a terminal progress is a bar with rate and time left; elsewhere, and in the log, a line every ten seconds. Nothing is coloured when
/// NO_COLOR is set or stdout is no terminal. Names and paths in messages may come from anybody: whatever is printed, and the log, is
/// without control characters and without commands to a runner of checks (core/base/printed_text.hpp).
#pragma once

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/types.hpp"
#include "design/cli/finding_files.hpp"

namespace fettle::design::cli {

enum ExitCode {
    exit_done = 0,       ///< done, and every requirement met: clearances are certified
    exit_violated = 1,   ///< a requirement is violated
    exit_undecided = 2,  ///< undecided or not converged
    exit_bad_input = 3,  ///< bad input or usage; output that cannot be written
    exit_internal = 4    ///< our own fault
};

struct ConsoleOptions {
    bool json = false;
    bool quiet = false;
    std::string log;            ///< file that gets narration and progress too, line by line; empty: none
    bool holds_answer = false;  ///< until give_answer(): files are written before, and the answer says if they cannot be
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

    /// The command's answer: the object with --json, else the text. What could not be written by then stands in it, as `unwritten`.
    void result(const nlohmann::ordered_json& json, const std::string& text);
    /// The one that is held, if there is one.
    void give_answer();

    /// Text alone, as that of --help.
    void print(const std::string& text);

    /// Files that the command should have written and did not: named on stderr and in the answer, which is given all the same.
    void unwritten(const Errors& errors);

    /// What the program ends with: `verdict`, or exit_bad_input where the answer, the log or a file could not be written. A fault of ours
    /// stays one.
    int exit_code(int verdict) const { return unwritten_.empty() || verdict == exit_internal ? verdict : static_cast<int>(exit_bad_input); }

    /// Errors in the input. With --json: {"status": "error", "errors": [{code, where, message}]} on stdout; else lines on stderr.
    /// @return exit_bad_input
    int input_errors(const Errors& errors);
    /// The same for a fault of ours. @return exit_internal
    int internal_error(const std::string& message);
    /// The same where there is not enough memory, with what was being done. @return exit_bad_input
    int out_of_memory();
    /// Reports that work was asked to stop before it had an answer. @return exit code
    int stopped();

    /// What was looked at, one thing each, for the files of finding_files.hpp; errors are added by themselves. `file` is kept if it is one.
    void found(Check check);
    const std::vector<Check>& checks() const { return checks_; }
    /// The file that the command is about: of checks that have no other.
    void set_about(std::string file) { about_ = std::move(file); }
    const std::string& about() const { return about_; }

    /// "clear" in green and so on, if colours are wanted: for texts of this console alone.
    std::string coloured(const std::string& text, bool good) const;

private:
    using Clock = std::chrono::steady_clock;
    struct Answer;
    void found_faults(const Errors& errors);
    void tell_answer(const nlohmann::ordered_json& json, const std::string& text);
    void log(const std::string& line);
    void log_failed();
    void put(const std::string& text);
    /// ", 35/s, 25 s left"; empty where nothing can be said.
    std::string pace(int done, int of) const;

    ConsoleOptions options_;
    std::vector<Check> checks_;
    std::string about_;
    std::shared_ptr<const Answer> held_;
    std::shared_ptr<std::FILE> log_;
    Clock::time_point begun_ = Clock::now();
    Errors unwritten_;
    std::string doing_;        ///< what was reported last
    std::string progress_of_;  ///< what the bar is about
    Clock::time_point progress_begun_, line_written_;
    int first_done_ = 0;
    bool terminal_ = false, colours_ = false, bar_shown_ = false;
    std::string mark_;  ///< what stands for colours until a text is printed
    int bar_permille_ = -1;
};

const char* to_string(ErrorCode code);

/// From now on a write that cannot be made is an error like any other: a file beyond the limit of its size raises no signal, and a standard
/// stream that is closed does not become the next file that is opened.
void expect_failed_writes();

}  // namespace fettle::design::cli
