// SPDX-License-Identifier: MIT
/// Programs that run beside this process, and end with it, however it ends.
///
///     Process process({.words = {"python3", "part.py"}, .out = *log});   throws where there is no such program
///     while (!process.ended()) wait_a_little();
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fettle::core::files {

/// An open file of this process, closed by the destructor; -1: none.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() { close(); }
    int operator*() const { return number_; }
    void close() {
        if (number_ >= 0) ::close(std::exchange(number_, -1));
    }

private:
    int number_;
};

/// The two ends of a pipe, which no child gets unless it is a stream of its own. Throws std::system_error.
struct Pipe {
    Pipe();
    Descriptor from, to;
};

/// What is started. Streams stay the caller's; -1: /dev/null.
struct Launch {
    std::vector<std::string> words;     ///< the program, looked for in PATH where it has no slash, and its arguments
    int in = -1, out = -1, error = -1;  ///< its standard streams
    std::string folder{};               ///< in which it runs; empty: that of this process
};

/// A child that still runs is killed by the destructor, with those that it started.
class Process {
public:
    /// Safe from any thread. It begins with no signal blocked or ignored, and in a group of its own: Ctrl-C reaches this process alone.
    /// Throws std::system_error, whose code is errno, where there is no such program, or the system starts none.
    explicit Process(const Launch& launch);
    Process(Process&& other) noexcept;
    Process& operator=(Process&& other) noexcept;
    ~Process() { kill(); }

    /// Its exit code once it has ended, without waiting; 128 + the signal that killed it; `lost`: somebody else has collected it.
    std::optional<int> ended();
    /// The same, waited for.
    int wait();
    /// Ends it at once, with its group. Nothing if it has ended.
    void kill();
    /// Asks it once to stop with what it has, as Ctrl-C does.
    void ask_to_stop();

    static constexpr int lost = -1;

private:
    std::optional<int> reaped(int options);

    pid_t process_ = -1;  // -1: none, or reaped
    int exit_code_ = lost;
    bool asked_ = false;
};

}  // namespace fettle::core::files
