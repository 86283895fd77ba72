// SPDX-License-Identifier: MIT
#include "core/mesh_files/import_process.hpp"

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
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/embedded_file.hpp"

FETTLE_EMBEDDED_FILE(fettle_mesh_importer, FETTLE_MESH_IMPORTER)
#ifdef FETTLE_STEP_IMPORTER
FETTLE_EMBEDDED_FILE(fettle_step_importer, FETTLE_STEP_IMPORTER)
#endif

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

/// A process that is waited for; if that does not come about it is killed, and leaves no zombie.
class Child {
public:
    explicit Child(pid_t process) : process_(process) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() { kill(); }
    void kill() {
        if (process_ < 0) return;
        ::kill(process_, SIGKILL);
        wait();
    }
    /// @return its status; nullopt if somebody else has collected it
    std::optional<int> wait() {
        int status = 0;
        pid_t reaped = -1;
        do reaped = ::waitpid(process_, &status, 0);
        while (reaped < 0 && errno == EINTR);
        const bool is_ours = reaped == std::exchange(process_, -1);
        return is_ours ? std::optional<int>(status) : std::nullopt;
    }

private:
    pid_t process_;
};

std::string_view bytes_of(Importer importer) {
#ifdef FETTLE_STEP_IMPORTER
    if (importer == Importer::step) return fettle_step_importer();
#endif
    return importer == Importer::assimp ? fettle_mesh_importer() : std::string_view();
}

/// A file without a name that has the importer in it; -1 and errno where the system makes none.
int importer_file(Importer importer) {
#ifdef MFD_EXEC
    int file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC | MFD_EXEC);
    if (file < 0 && errno == EINVAL) file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC);  // a kernel older than the flag
#else
    const int file = ::memfd_create("fettle mesh importer", MFD_CLOEXEC);
#endif
    std::string_view left = bytes_of(importer);
    const int code = file < 0 ? errno : files::write_all(file, left);
    if (code == 0) return file;
    if (file >= 0) ::close(file);
    errno = code;
    return -1;
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

/// All that comes, up to its end, a size and an hour, or until somebody wants it to stop. @return exited if it ended by itself
End collect(int from, std::uint64_t largest, Clock::time_point latest, const std::function<bool()>& should_stop, std::string& to) {
    constexpr long long between_looks = 100;  // [ms]
    std::vector<char> block(1 << 16);
    while (true) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(latest - Clock::now()).count();
        if (left <= 0) return End::out_of_time;
        if (should_stop && should_stop()) return End::stopped;
        pollfd wanted{from, POLLIN, 0};
        const int ready = ::poll(&wanted, 1, static_cast<int>(std::min<long long>(left, between_looks)));
        if (ready <= 0) continue;
        const ssize_t count = ::read(from, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return End::exited;
        to.append(block.data(), static_cast<std::size_t>(count));
        if (to.size() > largest) return End::too_large;
    }
}

}  // namespace

bool has_importer(Importer importer) { return !bytes_of(importer).empty(); }

ImportOutcome run_importer(Importer importer, const std::string& path, const std::vector<std::string>& more, const ImportLimits& limits,
                           const std::function<bool()>& should_stop) {
    ImportOutcome outcome;
    const Descriptor program(importer_file(importer));
    std::array<int, 2> ends{-1, -1};
    if (*program < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        outcome.code = errno;
        return outcome;
    }
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    pid_t process = -1;
    std::vector<std::string> words{"fettle mesh importer", path, std::to_string(limits.seconds), std::to_string(limits.memory),
                                   std::to_string(::getpid())};
    words.insert(words.end(), more.begin(), more.end());
    outcome.code = spawn(*program, std::move(words), *to, process);
    to.close();
    if (outcome.code != 0) return outcome;
    Child child(process);
    outcome.end = collect(*from, limits.largest, Clock::now() + 10 * std::chrono::seconds(limits.seconds), should_stop, outcome.written);
    if (outcome.end != End::exited) {
        child.kill();
    } else if (const std::optional<int> status = child.wait()) {  // else what it wrote tells enough
        if (WIFSIGNALED(*status)) outcome.end = WTERMSIG(*status) == SIGXCPU ? End::out_of_time : End::killed;
        outcome.code = WIFSIGNALED(*status) ? WTERMSIG(*status) : WEXITSTATUS(*status);
    }
    if (outcome.end != End::exited) outcome.written.clear();
    return outcome;
}

}  // namespace fettle::core::mesh_files
