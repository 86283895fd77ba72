// SPDX-License-Identifier: MIT
#include "design/cli/program_memory.hpp"
#include "tests/support/skip.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>

// Sanitizers have an allocator of their own.
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FETTLE_OTHER_ALLOCATOR
#endif
#endif
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(FETTLE_OTHER_ALLOCATOR)
#include <sys/mman.h>
#include <sys/resource.h>
#endif

namespace fettle::design::cli::program_memory_test {

TEST_CASE("What is to be done for memory ahead can be done on any thread, and the memory is free afterwards") {
    keep_freed_memory();
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, std::size_t{3} << 20})
        if (const std::function<void()> job = memory_ahead(bytes)) std::thread(job).join();
}

TEST_CASE("A library that ends the program ends it with its own words and exit code") {
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(ends[1], STDOUT_FILENO);
        ::dup2(ends[1], STDERR_FILENO);
        expect_out_of_memory(true);
        std::exit(2);  // as Fortran's does
    }
    ::close(ends[1]);
    std::string told;
    char buffer[1024];
    for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) told.append(buffer, static_cast<std::size_t>(n));
    ::close(ends[0]);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 3);
    CHECK(told.find("\"out_of_memory\"") != std::string::npos);
}

#ifdef MADV_POPULATE_WRITE

namespace {

long page_faults() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

// The page faults of the first use of so much new memory.
long faults_of_use(std::size_t bytes) {
    const long before = page_faults();
    auto* const block = static_cast<volatile char*>(std::malloc(bytes));
    for (std::size_t i = 0; i < bytes; i += 4096) block[i] = 1;
    const long after = page_faults();
    std::free(const_cast<char*>(block));
    return after - before;
}

bool system_provides_memory() {
    void* const page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    const bool provides = page != MAP_FAILED && madvise(page, 4096, MADV_POPULATE_WRITE) == 0;
    if (page != MAP_FAILED) munmap(page, 4096);
    return provides;
}

}  // namespace

TEST_CASE("Memory that another thread had provided is used without a fault of its pages") {
    if (!system_provides_memory()) FETTLE_SKIP("this system provides no memory ahead");
    constexpr std::size_t megabyte = 1 << 20;
    keep_freed_memory();
    const std::function<void()> job = memory_ahead(24 * megabyte);
    REQUIRE(job);
    std::thread(job).join();
    CHECK(faults_of_use(20 * megabyte) < 200);  // of 5,120 pages
    CHECK_FALSE(memory_ahead(SIZE_MAX / 4));    // there is not so much
}

#endif

}  // namespace fettle::design::cli::program_memory_test
