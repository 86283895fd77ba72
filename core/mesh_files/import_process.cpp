// SPDX-License-Identifier: MIT
#include "fettle/core/mesh_files/import_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <utility>
#include <vector>

// The importer as a file, put in by the assembler between two labels.
asm(".pushsection .rodata\n"
    ".global fettle_mesh_importer_begin\n"
    ".hidden fettle_mesh_importer_begin\n"
    ".global fettle_mesh_importer_end\n"
    ".hidden fettle_mesh_importer_end\n"
    "fettle_mesh_importer_begin:\n"
    ".incbin \"" FETTLE_MESH_IMPORTER
    "\"\n"
    "fettle_mesh_importer_end:\n"
    ".popsection\n");

extern "C" {
extern const char fettle_mesh_importer_begin[] __attribute__((visibility("hidden")));
extern const char fettle_mesh_importer_end[] __attribute__((visibility("hidden")));
}

namespace fettle::core::mesh_files {
namespace {

using Clock = std::chrono::steady_clock;

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close() {
        if (number_ >= 0) ::close(std::exchange(number_, -1));
    }
    int operator*() const { return number_; }

private:
    int number_;
};

/// A file without a name that has the importer in it; -1 and errno where the system makes none.
int importer_file() {
#ifdef MFD_EXEC
    int file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC | MFD_EXEC);
    if (file < 0 && errno == EINVAL) file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC);  // a kernel older than the flag
#else
    const int file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC);
#endif
    const char* at = fettle_mesh_importer_begin;
    while (file >= 0 && at < fettle_mesh_importer_end) {
        const ssize_t written = ::write(file, at, static_cast<std::size_t>(fettle_mesh_importer_end - at));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const int code = errno;
            ::close(file);
            errno = code;
            return -1;
        }
        at += written;
    }
    return file;
}

/// Starts it with `out` as stdout and nothing else of ours. @return 0, or errno
int spawn(int program, std::vector<std::string> words, int out, pid_t& process) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string path = "/proc/self/fd/" + std::to_string(program);
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);  // what an abort prints is for nobody
    ::posix_spawnattr_init(&attributes);
    sigset_t none, usual;
    ::sigemptyset(&none);
    ::sigfillset(&usual);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setsigdefault(&attributes, &usual);
    ::posix_spawnattr_setpgroup(&attributes, 0);  // Ctrl-C is for the parent, with which it ends
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    const int code = ::posix_spawn(&process, path.c_str(), &actions, &attributes, arguments.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    return code;
}

using End = ImportOutcome::End;

/// All that comes, up to its end, a size and an hour. @return exited if it ended by itself
End collect(int from, std::uint64_t largest, Clock::time_point latest, std::string& to) {
    std::vector<char> block(1 << 16);
    while (true) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(latest - Clock::now()).count();
        if (left <= 0) return End::out_of_time;
        pollfd wanted{from, POLLIN, 0};
        const int ready = ::poll(&wanted, 1, static_cast<int>(std::min<long long>(left, 60'000)));
        if (ready <= 0) continue;
        const ssize_t count = ::read(from, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return End::exited;
        to.append(block.data(), static_cast<std::size_t>(count));
        if (to.size() > largest) return End::too_large;
    }
}

}  // namespace

ImportOutcome run_importer(const std::string& path, const ImportLimits& limits) {
    ImportOutcome outcome;
    const Descriptor program(importer_file());
    std::array<int, 2> ends{-1, -1};
    if (*program < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        outcome.code = errno;
        return outcome;
    }
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    pid_t process = -1;
    outcome.code = spawn(
        *program, {"fettle mesh importer", path, std::to_string(limits.seconds), std::to_string(limits.memory), std::to_string(::getpid())},
        *to, process);
    to.close();
    if (outcome.code != 0) return outcome;
    outcome.end = collect(*from, limits.largest, Clock::now() + 10 * std::chrono::seconds(limits.seconds), outcome.written);
    if (outcome.end != End::exited) ::kill(process, SIGKILL);
    int status = 0;
    pid_t reaped = -1;
    do reaped = ::waitpid(process, &status, 0);
    while (reaped < 0 && errno == EINTR);
    if (outcome.end == End::exited && reaped == process) {  // else somebody else has collected it: what it wrote tells enough
        if (WIFSIGNALED(status)) outcome.end = WTERMSIG(status) == SIGXCPU ? End::out_of_time : End::killed;
        outcome.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    }
    if (outcome.end != End::exited) outcome.written.clear();
    return outcome;
}

}  // namespace fettle::core::mesh_files
