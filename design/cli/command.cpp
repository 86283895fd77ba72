// SPDX-License-Identifier: MIT
#include "design/cli/command.hpp"

#include <atomic>
#include <csignal>

namespace fettle::design::cli {

namespace {

// A signal handler can reach nothing but an object of static storage.
std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "what a signal handler may write");

extern "C" void on_interrupt(int signal) {
    interrupt_seen = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_seen; }

}  // namespace fettle::design::cli
