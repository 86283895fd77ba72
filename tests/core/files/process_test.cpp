// SPDX-License-Identifier: MIT
// process.hpp: streams, folders and ends of children; programs that are not there; what is left of those that are killed.
#include "core/files/process.hpp"

#include <fcntl.h>
#include <signal.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <system_error>
#include <thread>

#include "tests/support/temporary_folder.hpp"

namespace fettle::core::files::process_test {

namespace {

Launch shell(const std::string& command) { return {.words = {"sh", "-c", command}}; }

std::string all_of(Descriptor& from) {
    std::string text(4096, ' ');
    std::string out;
    for (ssize_t size = 1; size > 0;) {
        size = ::read(*from, text.data(), text.size());
        if (size > 0) out.append(text, 0, static_cast<std::size_t>(size));
    }
    return out;
}

// The entry of a killed orphan stays until init has collected it.
bool runs(pid_t process) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    return (stat >> number >> name >> state) && state != "Z";
}

bool ends(pid_t process) {
    for (int k = 0; k < 500 && runs(process); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return !runs(process);
}

}  // namespace

TEST_CASE("process: exit codes, and the signals that ended it") {
    CHECK(Process(shell("exit 0")).wait() == 0);
    CHECK(Process(shell("exit 7")).wait() == 7);
    CHECK(Process(shell("kill -XCPU $$")).wait() == 128 + SIGXCPU);
    Process sleeping(shell("sleep 60"));
    CHECK_FALSE(sleeping.ended());
    sleeping.ask_to_stop();
    CHECK(sleeping.wait() == 128 + SIGTERM);
    CHECK(sleeping.ended() == 128 + SIGTERM);
    sleeping.kill();
    CHECK(sleeping.wait() == 128 + SIGTERM);
}

TEST_CASE("process: streams are those given, all others nothing, in the folder given") {
    const tests::support::TemporaryFolder folder;
    Pipe in, out;
    Process process({.words = {"sh", "-c", "read line; echo \"$line in $(pwd)\"; echo lost >&2"},
                     .in = *in.from,
                     .out = *out.to,
                     .folder = folder.file("")});
    out.to.close();
    REQUIRE(::write(*in.to, "words\n", 6) == 6);
    const std::string said = all_of(out.from);
    CHECK(said.starts_with("words in /"));
    CHECK(said.find("lost") == std::string::npos);
    CHECK(process.wait() == 0);
}

TEST_CASE("process: a program that is not there, or cannot run, is told at once") {
    const tests::support::TemporaryFolder folder;
    const auto code = [](const Launch& launch) {
        try {
            Process process(launch);
        } catch (const std::system_error& error) {
            return error.code().value();
        }
        return 0;
    };
    CHECK(code({.words = {"no_such_program_anywhere"}}) == ENOENT);
    CHECK(code({.words = {folder.file("none")}}) == ENOENT);
    CHECK(code({.words = {"sh"}, .folder = folder.file("none")}) == ENOENT);
    CHECK(code({.words = {"/"}}) == EACCES);
    CHECK(code({.words = {"true"}}) == 0);
}

TEST_CASE("process: it begins with no signal blocked or ignored") {
    sigset_t blocked, before;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &blocked, &before);
    const auto ignored = ::signal(SIGTERM, SIG_IGN);
    Process process(shell("sleep 60"));
    ::signal(SIGTERM, ignored);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    process.ask_to_stop();
    CHECK(process.wait() == 128 + SIGTERM);
}

TEST_CASE("process: what nobody waits for is killed, with what it has started") {
    Pipe out;
    pid_t grandchild = -1;
    {
        const Process process({.words = {"sh", "-c", "sleep 60 & echo $!; wait"}, .out = *out.to});
        std::string line;
        for (char c = ' '; c != '\n' && ::read(*out.from, &c, 1) == 1;) line += c;
        grandchild = static_cast<pid_t>(std::stol(line));
        CHECK(runs(grandchild));
    }
    CHECK(ends(grandchild));
}

}  // namespace fettle::core::files::process_test
