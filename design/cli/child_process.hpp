// SPDX-License-Identifier: MIT
/// Runs of this program beside this process. They end with it, however it ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fettle::design::cli {

/// One run: what it prints on stdout is dropped, what on stderr goes to a file. A child that still runs is killed by the destructor.
class ChildProcess {
public:
    /// Starts this program (the same executable) with these arguments. Throws std::runtime_error if the system has no process left.
    static ChildProcess start(const std::vector<std::string>& arguments, const std::filesystem::path& log);

    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&& other) noexcept;
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    /// Its exit code, once it has ended; 128 + the signal that killed it. Does not wait.
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

}  // namespace fettle::design::cli
