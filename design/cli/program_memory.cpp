// SPDX-License-Identifier: MIT
#include "design/cli/program_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "design/cli/console.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace fettle::design::cli {

#ifdef __GLIBC__
namespace {

constexpr int megabyte = 1 << 20;

// The whole pages of a block of free memory. What the system refuses it will do later, page by page.
void have_cleared(void* block, std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = (reinterpret_cast<std::uintptr_t>(block) + page - 1) / page * page;
    const auto end = (reinterpret_cast<std::uintptr_t>(block) + bytes) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
#endif
}

}  // namespace
#endif

namespace {

constexpr std::size_t reserve_bytes = std::size_t{8} << 20;

// Handlers reach nothing but objects of static storage.
std::atomic<void*> reserve{nullptr};
std::atomic<bool> ran_out{false}, answers_json{false}, has_ended{false};

void on_no_memory() {
    ran_out = true;
    void* const kept = reserve.exchange(nullptr);
    std::free(kept);
    if (kept != nullptr && std::uncaught_exceptions() > 0) return;  // what unwinds is given it
    throw std::bad_alloc();
}

bool is_about_memory(const std::exception_ptr& thrown) {
    if (ran_out || !thrown) return ran_out;
    try {
        std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        return true;
    } catch (...) {
        return false;
    }
}

[[noreturn]] void on_terminate() {
    if (is_about_memory(std::current_exception())) end_out_of_memory();
    std::abort();
}

// Libraries in C abort, or go on with no memory. Asking the system is all that a signal handler may do.
bool system_has_memory() {
    constexpr std::size_t bytes = std::size_t{1} << 20;
    void* const block = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (block == MAP_FAILED) return false;
    ::munmap(block, bytes);
    return true;
}

extern "C" void on_crash(int signal) {
    if (ran_out || !system_has_memory()) end_out_of_memory();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void on_exit_of_others() {
    if (!has_ended) end_out_of_memory();
}

// Sanitizers tell of crashes themselves.
constexpr bool tells_crashes() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(undefined_behavior_sanitizer)
    return false;
#else
    return true;
#endif
#else
    return true;
#endif
}

void put(int stream, std::string_view text) {
    if (::write(stream, text.data(), text.size()) < 0) return;  // there is nobody left to tell
}

}  // namespace

void expect_out_of_memory(bool json) {
    answers_json = json;
    reserve = std::malloc(reserve_bytes);
    std::set_new_handler(on_no_memory);
    std::set_terminate(on_terminate);
    std::atexit(on_exit_of_others);
    if (!tells_crashes()) return;
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) std::signal(signal, on_crash);
}

int ended(int code) {
    has_ended = true;
    return code;
}

void end_out_of_memory() {
    if (answers_json)
        put(STDOUT_FILENO,
            "{\n  \"status\": \"error\",\n  \"errors\": [\n    {\n      \"code\": \"out_of_memory\",\n      \"where\": \"memory\",\n"
            "      \"message\": \"the request needs more memory than there is\"\n    }\n  ]\n}\n");
    put(STDERR_FILENO, "error: memory: the request needs more memory than there is [out_of_memory]\n");
    ::_exit(exit_bad_input);
}

void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 * megabyte);
    mallopt(M_TRIM_THRESHOLD, 512 * megabyte);
    mallopt(M_TOP_PAD, 16 * megabyte);
#endif
}

std::function<void()> memory_ahead(std::size_t bytes) {
#ifdef __GLIBC__
    void* const block = std::malloc(bytes);  // here: each thread has memory of its own
    if (block == nullptr) return {};
    return [block, bytes] {
        have_cleared(block, bytes);
        std::free(block);
    };
#else
    return {};
#endif
}

}  // namespace fettle::design::cli
