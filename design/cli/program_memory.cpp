// SPDX-License-Identifier: MIT
#include "fettle/design/cli/program_memory.hpp"

#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
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
