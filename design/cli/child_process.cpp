// SPDX-License-Identifier: MIT
#include "fettle/design/cli/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace fettle::design::cli {

namespace {

constexpr int could_not_start = 127;

// Between fork and exec, where nothing may allocate or lock: the parent has other threads.
[[noreturn]] void become(char* const* arguments, const char* log, pid_t parent) {
    // Nobody would collect what it finds: it dies with the parent, and what its history holds is not lost.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(could_not_start);
    setpgid(0, 0);  // Ctrl-C reaches the parent alone, who passes it on once
    const int in = open("/dev/null", O_RDWR), out = open(log, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0644);
    if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(in, 1) < 0 || dup2(out, 2) < 0) _exit(could_not_start);
    execv("/proc/self/exe", arguments);
    _exit(could_not_start);
}

}  // namespace

ChildProcess ChildProcess::start(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
    std::vector<std::string> words{"fettle"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string log_name = log.string();
    unlink(log_name.c_str());  // a file of its own: what a link there points at is left alone
    const pid_t parent = getpid();
    const pid_t process = fork();
    if (process == 0) become(pointers.data(), log_name.c_str(), parent);
    if (process < 0) throw std::runtime_error(std::string("a run of its own cannot be started: ") + std::strerror(errno));
    return ChildProcess(process);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)), exit_code_(other.exit_code_), asked_(other.asked_) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
    if (this == &other) return *this;
    kill_and_reap();
    process_ = std::exchange(other.process_, -1);
    exit_code_ = other.exit_code_;
    asked_ = other.asked_;
    return *this;
}

ChildProcess::~ChildProcess() { kill_and_reap(); }

void ChildProcess::kill_and_reap() {
    if (process_ < 0) return;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
}

std::optional<int> ChildProcess::ended() {
    if (process_ < 0) return exit_code_;
    int status = 0;
    const pid_t reaped = waitpid(process_, &status, WNOHANG);
    if (reaped == 0 || (reaped < 0 && errno == EINTR)) return std::nullopt;
    process_ = -1;
    exit_code_ = reaped < 0 ? could_not_start : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return exit_code_;
}

void ChildProcess::ask_to_stop() {
    if (process_ < 0 || asked_) return;
    asked_ = true;
    kill(process_, SIGTERM);
}

}  // namespace fettle::design::cli
