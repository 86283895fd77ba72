// SPDX-License-Identifier: MIT
#include "core/linear/library_threads.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <mutex>
#include <new>

namespace fettle::core::linear {
namespace {

// OpenBLAS, which is one for the whole program.
struct Pinned {
    std::mutex mutex;
    int holders = 0, before = 1;
};

Pinned& pinned() {
    static Pinned state;
    return state;
}

}  // namespace

LibraryThreads threads_of(const base::SharedLibrary* library) {
    const auto find = [&]<class Function>(const char* symbol, Function*& function) {
        function = reinterpret_cast<Function*>(library != nullptr ? library->find_any(symbol) : dlsym(RTLD_DEFAULT, symbol));
    };
    LibraryThreads out;
    find("openblas_set_num_threads", out.set_blas);
    find("openblas_get_num_threads", out.blas);
    find("omp_set_max_active_levels", out.set_levels);
    find("omp_get_max_active_levels", out.levels);
    if (out.blas == nullptr) out.set_blas = nullptr;
    if (out.set_blas != nullptr) find("dsyrk_", out.rank_update);
    if (out.levels == nullptr) out.set_levels = nullptr;
    return out;
}

void take_blas_buffer(const LibraryThreads& threads) {
    constexpr std::size_t bytes = std::size_t{130} << 20;
    static thread_local bool has_it = false;
    if (has_it || threads.rank_update == nullptr) return;
    void* volatile block = std::malloc(bytes);  // none of it is touched
    if (block == nullptr) throw std::bad_alloc();
    std::free(block);
    const int one = 1;
    const double number = 1, zero = 0;
    double result = 0;
    threads.rank_update("L", "N", &one, &one, &number, &number, &one, &zero, &result, &one);
    has_it = true;
}

OneLibraryThread::OneLibraryThread(const LibraryThreads& threads) : threads_(threads) {
    take_blas_buffer(threads_);
    if (threads_.set_levels != nullptr) {
        levels_ = threads_.levels();
        threads_.set_levels(0);
    }
    if (threads_.set_blas == nullptr) return;
    const std::lock_guard lock(pinned().mutex);
    if (pinned().holders++ > 0) return;
    pinned().before = threads_.blas();
    if (pinned().before != 1) threads_.set_blas(1);
}

OneLibraryThread::~OneLibraryThread() {
    if (threads_.set_levels != nullptr) threads_.set_levels(levels_);
    if (threads_.set_blas == nullptr) return;
    const std::lock_guard lock(pinned().mutex);
    if (--pinned().holders == 0 && pinned().before != 1) threads_.set_blas(pinned().before);
}

}  // namespace fettle::core::linear
