// SPDX-License-Identifier: MIT
#include "core/files/process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace fettle::core::files {

namespace {

[[noreturn]] void refuse(int code, const std::string& what) { throw std::system_error(code, std::generic_category(), what); }

/// What the child needs, made before it is there: after fork nothing may allocate or lock, since other threads may hold any lock.
struct Beginning {
    char* const* words;
    std::array<int, 3> streams;
    const char* folder;
    int fault;  // where errno goes if it cannot begin
    pid_t parent;
};

bool begin(const Beginning& beginning) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != beginning.parent) return false;
    ::setpgid(0, 0);
    for (int number = 1; number < NSIG; ++number) ::signal(number, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    for (int stream = 0; stream < 3; ++stream) {
        const int given = beginning.streams[stream];
        if (::dup2(given < 0 ? nothing : given, stream) < 0) return false;
    }
    if (*beginning.folder != '\0' && ::chdir(beginning.folder) != 0) return false;
    ::execvp(beginning.words[0], beginning.words);
    return false;
}

[[noreturn]] void become(const Beginning& beginning) {
    begin(beginning);
    const int code = errno;
    const ssize_t ignored = ::write(beginning.fault, &code, sizeof code);
    ::_exit(ignored < 0 ? 126 : 127);
}

// errno of a child that could not begin; 0: its program runs.
int fault_of(Pipe& pipe) {
    pipe.to.close();
    int code = 0;
    ssize_t size = -1;
    do size = ::read(*pipe.from, &code, sizeof code);
    while (size < 0 && errno == EINTR);
    return size == sizeof code ? code : 0;
}

}  // namespace

Pipe::Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(errno, "there is no pipe left");
    from = Descriptor(ends[0]);
    to = Descriptor(ends[1]);
}

Process::Process(const Launch& launch) {
    std::vector<std::string> words = launch.words;
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string refusal = launch.words.front() + " cannot be started";
    Pipe fault;
    const Beginning beginning{pointers.data(), {launch.in, launch.out, launch.error}, launch.folder.c_str(), *fault.to, ::getpid()};
    process_ = ::fork();
    if (process_ == 0) become(beginning);
    if (process_ < 0) refuse(errno, refusal);
    const int code = fault_of(fault);
    if (code == 0) return;
    wait();
    refuse(code, refusal);
}

Process::Process(Process&& other) noexcept
    : process_(std::exchange(other.process_, -1)), exit_code_(other.exit_code_), asked_(other.asked_) {}

Process& Process::operator=(Process&& other) noexcept {
    std::swap(process_, other.process_);
    std::swap(exit_code_, other.exit_code_);
    std::swap(asked_, other.asked_);
    return *this;
}

std::optional<int> Process::reaped(int options) {
    if (process_ < 0) return exit_code_;
    int status = 0;
    pid_t found = -1;
    do found = ::waitpid(process_, &status, options);
    while (found < 0 && errno == EINTR);
    if (found == 0) return std::nullopt;
    process_ = -1;
    exit_code_ = found < 0 ? lost : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return exit_code_;
}

std::optional<int> Process::ended() { return reaped(WNOHANG); }

int Process::wait() { return *reaped(0); }

void Process::kill() {
    if (process_ < 0) return;
    ::kill(-process_, SIGKILL);
    ::kill(process_, SIGKILL);
    wait();
}

void Process::ask_to_stop() {
    if (process_ < 0 || std::exchange(asked_, true)) return;
    ::kill(process_, SIGTERM);
}

}  // namespace fettle::core::files
