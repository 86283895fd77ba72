// SPDX-License-Identifier: MIT
/// Programs that run beside this process, and end with it, however it ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::design::cli {

/// A child that still runs is killed by the destructor.
class ChildProcess {
public:
    /// Starts this program (the same executable) with these arguments. Its stdout is dropped, its stderr goes to a file. Throws
    /// std::runtime_error if the system has no process left.
    static ChildProcess start(const std::vector<std::string>& arguments, const std::filesystem::path& log);

    /// Descriptors of a child's standard streams; -1: /dev/null.
    struct Streams {
        int in = -1, out = -1, error = -1;
    };
    /// Starts the executable words[0], looked for in PATH where it has no slash. The streams stay the caller's. Throws the same.
    static ChildProcess start(const std::vector<std::string>& words, const Streams& streams);

    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) noexcept;
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    /// Its exit code, once it has ended; 128 + the signal that killed it; 127: it could not be started. Does not wait.
    std::optional<int> ended();
    /// Asks it to stop with what it has, as Ctrl-C does. Once is enough: a second time ends it at once.
    void ask_to_stop();

private:
    explicit ChildProcess(pid_t process) : process_(process) {}
    void kill_and_reap();

    pid_t process_ = -1;  // -1: none, or reaped
    std::optional<int> exit_code_;
    bool asked_ = false;
};

/// A child that is told lines and answers in lines.
class TalkingProcess {
public:
    /// Its stderr is this process's. Throws std::runtime_error if the system has no process left.
    explicit TalkingProcess(const std::vector<std::string>& words);
    TalkingProcess(TalkingProcess&& other) noexcept;
    TalkingProcess& operator=(TalkingProcess&&) = delete;
    ~TalkingProcess();

    /// Writes all of it. @return false: it does not listen any more
    bool tell(std::string_view text);
    void tell_no_more();
    /// Its next line, without the line feed; nothing: it will say no more, or should_stop said so, which is asked every 50 ms.
    std::optional<std::string> next_line(const std::function<bool()>& should_stop);

private:
    std::optional<ChildProcess> process_;
    int to_ = -1, from_ = -1;
    std::string heard_;
};

}  // namespace fettle::design::cli
