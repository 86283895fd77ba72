// SPDX-License-Identifier: MIT
#include "design/cli/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/files/atomic_file.hpp"

namespace fettle::design::cli {

namespace {

constexpr int could_not_start = 127;

// Between fork and exec, where nothing may allocate or lock: the parent has other threads.
[[noreturn]] void become(char* const* words, const ChildProcess::Streams& streams, pid_t parent) {
    // Nobody would collect its results: it dies with the parent, and what its history holds is not lost.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(could_not_start);
    setpgid(0, 0);  // Ctrl-C reaches the parent alone, who passes it on once
    const int nothing = open("/dev/null", O_RDWR);
    const int given[] = {streams.in, streams.out, streams.error};
    for (int stream = 0; stream < 3; ++stream)
        if (dup2(given[stream] < 0 ? nothing : given[stream], stream) < 0) _exit(could_not_start);
    execvp(words[0], words);
    _exit(could_not_start);
}

// As the parent has it open: no other child gets it.
class Descriptor {
public:
    explicit Descriptor(int file) : file_(file) {}
    ~Descriptor() {
        if (file_ >= 0) close(file_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return file_; }
    int release() { return std::exchange(file_, -1); }

private:
    int file_;
};

}  // namespace

ChildProcess ChildProcess::start(const std::vector<std::string>& arguments, const std::filesystem::path& log) {
    std::vector<std::string> words{"/proc/self/exe"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    unlink(log.c_str());  // a file of its own: what a link there points at is left alone
    const Descriptor file(open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
    if (file.get() < 0) throw std::runtime_error(log.string() + " cannot be written: " + std::strerror(errno));
    return start(words, {-1, -1, file.get()});
}

ChildProcess ChildProcess::start(const std::vector<std::string>& words, const Streams& streams) {
    std::vector<std::string> copies = words;
    std::vector<char*> pointers;
    for (std::string& word : copies) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t parent = getpid();
    const pid_t process = fork();
    if (process == 0) become(pointers.data(), streams, parent);
    if (process < 0) throw std::runtime_error(std::string("a process of its own cannot be started: ") + std::strerror(errno));
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

TalkingProcess::TalkingProcess(const std::vector<std::string>& words) {
    int in[2], out[2];
    if (pipe2(in, O_CLOEXEC) != 0) throw std::runtime_error(std::string("there is no pipe left: ") + std::strerror(errno));
    Descriptor its_in(in[0]), to(in[1]);
    if (pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error(std::string("there is no pipe left: ") + std::strerror(errno));
    Descriptor from(out[0]), its_out(out[1]);
    process_.emplace(ChildProcess::start(words, {its_in.get(), its_out.get(), STDERR_FILENO}));
    to_ = to.release();
    from_ = from.release();
}

TalkingProcess::TalkingProcess(TalkingProcess&& other) noexcept
    : process_(std::move(other.process_)),
      to_(std::exchange(other.to_, -1)),
      from_(std::exchange(other.from_, -1)),
      heard_(std::move(other.heard_)) {}

TalkingProcess::~TalkingProcess() {
    tell_no_more();
    if (from_ >= 0) close(from_);
}

bool TalkingProcess::tell(std::string_view text) { return core::files::write_all(to_, text) == 0; }

void TalkingProcess::tell_no_more() {
    if (to_ >= 0) close(std::exchange(to_, -1));
}

std::optional<std::string> TalkingProcess::next_line(const std::function<bool()>& should_stop) {
    constexpr int patience = 50;  // ms
    for (;;) {
        if (const std::size_t end = heard_.find('\n'); end != std::string::npos) {
            std::string line = heard_.substr(0, end);
            heard_.erase(0, end + 1);
            return line;
        }
        if (should_stop && should_stop()) return std::nullopt;
        pollfd waiting{from_, POLLIN, 0};
        if (poll(&waiting, 1, patience) <= 0) continue;
        char buffer[65536];
        const ssize_t size = read(from_, buffer, sizeof buffer);
        if (size == 0 || (size < 0 && errno != EINTR)) return std::nullopt;
        if (size > 0) heard_.append(buffer, static_cast<std::size_t>(size));
    }
}

}  // namespace fettle::design::cli
