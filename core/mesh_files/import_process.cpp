// SPDX-License-Identifier: MIT
#include "core/mesh_files/import_process.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/embedded_file.hpp"
#include "core/files/process.hpp"

FETTLE_EMBEDDED_FILE(fettle_mesh_importer, FETTLE_MESH_IMPORTER)
#ifdef FETTLE_STEP_IMPORTER
FETTLE_EMBEDDED_FILE(fettle_step_importer, FETTLE_STEP_IMPORTER)
#endif

namespace fettle::core::mesh_files {
namespace {

using Clock = std::chrono::steady_clock;

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
    const files::Descriptor program(importer_file(importer));
    if (*program < 0) {
        outcome.code = errno;
        return outcome;
    }
    files::Launch launch{
        .words = {"/proc/self/fd/" + std::to_string(*program), path, std::to_string(limits.seconds), std::to_string(limits.memory)}};
    launch.words.insert(launch.words.end(), more.begin(), more.end());
    std::optional<files::Pipe> pipe;
    std::optional<files::Process> process;
    try {
        launch.out = *pipe.emplace().to;
        process.emplace(launch);
    } catch (const std::system_error& error) {
        outcome.code = error.code().value();
        return outcome;
    }
    pipe->to.close();
    const auto latest = Clock::now() + 10 * std::chrono::seconds(limits.seconds);
    outcome.end = collect(*pipe->from, limits.largest, latest, should_stop, outcome.written);
    if (outcome.end != End::exited) process->kill();
    const int code = process->wait();
    if (outcome.end == End::exited && code != files::Process::lost) {  // else what it wrote tells enough
        const bool is_killed = code > 128;
        if (is_killed) outcome.end = code - 128 == SIGXCPU ? End::out_of_time : End::killed;
        outcome.code = is_killed ? code - 128 : code;
    }
    if (outcome.end != End::exited) outcome.written.clear();
    return outcome;
}

}  // namespace fettle::core::mesh_files
