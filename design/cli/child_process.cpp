// SPDX-License-Identifier: MIT
#include "design/cli/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/files/atomic_file.hpp"

namespace fettle::design::cli {

using core::files::Descriptor;
using core::files::Launch;
using core::files::Pipe;
using core::files::Process;

Process start_self(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
    Launch launch{.words = {"/proc/self/exe"}};
    launch.words.insert(launch.words.end(), arguments.begin(), arguments.end());
    unlink(log.c_str());  // a file of its own: what a link there points at is left alone
    const Descriptor file(open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
    if (*file < 0) throw std::runtime_error(log.string() + " cannot be written: " + std::strerror(errno));
    launch.error = *file;
    return Process(launch);
}

TalkingProcess::TalkingProcess(const std::vector<std::string>& words) {
    Pipe in, out;
    process_.emplace(Launch{.words = words, .in = *in.from, .out = *out.to, .error = STDERR_FILENO});
    to_ = std::move(in.to);
    from_ = std::move(out.from);
}

bool TalkingProcess::tell(std::string_view text) { return core::files::write_all(*to_, text) == 0; }

void TalkingProcess::tell_no_more() { to_.close(); }

std::optional<std::string> TalkingProcess::next_line(const std::function<bool()>& should_stop) {
    constexpr int patience = 50;  // ms
    for (;;) {
        if (const std::size_t end = heard_.find('\n'); end != std::string::npos) {
            std::string line = heard_.substr(0, end);
            heard_.erase(0, end + 1);
            return line;
        }
        if (should_stop && should_stop()) return std::nullopt;
        pollfd waiting{*from_, POLLIN, 0};
        if (poll(&waiting, 1, patience) <= 0) continue;
        char buffer[65536];
        const ssize_t size = read(*from_, buffer, sizeof buffer);
        if (size == 0 || (size < 0 && errno != EINTR)) return std::nullopt;
        if (size > 0) heard_.append(buffer, static_cast<std::size_t>(size));
    }
}

}  // namespace fettle::design::cli
