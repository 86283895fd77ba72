// SPDX-License-Identifier: MIT
#include "tests/benchmarks/child_run.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

namespace fettle::tests::benchmarks {
namespace {

double seconds(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

[[noreturn]] void be_child(const std::function<int()>& work, double cpu_seconds, const int (&ends)[2]) {
    const auto limit = static_cast<rlim_t>(cpu_seconds) + 1;
    const rlimit cpu_limit{limit, limit + 5};
    setrlimit(RLIMIT_CPU, &cpu_limit);
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    const int code = work();
    std::fflush(stdout);
    _exit(code);
}

}  // namespace

bool ChildRun::ran_out_of_time() const { return signal == SIGXCPU || signal == SIGKILL; }

ChildRun run_child(const std::function<int()>& work, double cpu_seconds) {
    ChildRun run;
    int ends[2];
    if (pipe(ends) != 0) return run;
    std::fflush(stdout);  // else the child would write it once more
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) be_child(work, cpu_seconds, ends);
    close(ends[1]);
    char buffer[4096];
    for (ssize_t n; child > 0 && (n = read(ends[0], buffer, sizeof buffer)) > 0;) run.out.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    rusage usage{};
    if (child < 0 || wait4(child, &status, 0, &usage) != child) return run;
    run.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    run.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    run.peak_memory_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
    if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
    return run;
}

}  // namespace fettle::tests::benchmarks
