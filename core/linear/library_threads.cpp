// SPDX-License-Identifier: MIT
#include "fettle/core/linear/library_threads.hpp"

#include <dlfcn.h>

#include <mutex>

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
    if (out.levels == nullptr) out.set_levels = nullptr;
    return out;
}

OneLibraryThread::OneLibraryThread(const LibraryThreads& threads) : threads_(threads) {
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
