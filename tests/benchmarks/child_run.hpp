// SPDX-License-Identifier: MIT
/// Work in a process of its own: its time and memory are its own, and neither a crash nor what never ends takes the caller with it.
#pragma once

#include <functional>
#include <string>

namespace fettle::tests::benchmarks {

struct ChildRun {
    int exit_code = -1;       ///< -1: it did not end by itself
    int signal = 0;           ///< that ended it
    std::string out;          ///< what it wrote to standard output
    double cpu_seconds = 0;   ///< of all its threads, in the kernel too, from its start to its end
    double wall_seconds = 0;  ///< likewise
    double peak_memory_bytes = 0;

    bool ran_out_of_time() const;
};

/// Runs `work` in a fork of this process; its result is the exit code. Its file 1 is caught: write(1, ..) or a flushed stdout.
/// @param cpu_seconds  after which the kernel ends it.
/// Contract: no thread but the caller's has been started.
ChildRun run_child(const std::function<int()>& work, double cpu_seconds);

}  // namespace fettle::tests::benchmarks
