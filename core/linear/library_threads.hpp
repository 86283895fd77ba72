// SPDX-License-Identifier: MIT
/// SuiteSparse's dense work is done by a BLAS, and some of its loops by OpenMP. Both have threads of their own; fettle's are enough, and
/// the bits of an answer are not to depend on how many there are.
#pragma once

#include "fettle/core/base/shared_library.hpp"

namespace fettle::core::linear {

/// What a library's threads are set by; null: it has no such threads.
struct LibraryThreads {
    void (*set_blas)(int) = nullptr;  ///< OpenBLAS's; null: the BLAS is another one
    int (*blas)() = nullptr;
    void (*set_levels)(int) = nullptr;  ///< OpenMP's depth of parallel regions, of the calling thread
    int (*levels)() = nullptr;
};

/// The threads of `library` and of those that it was linked with. @param library  null: of the whole program
LibraryThreads threads_of(const base::SharedLibrary* library);

/// While it lives OpenBLAS works on one thread, for everybody (the last one to go puts back what was), and OpenMP's regions on the calling
/// thread alone. Costs next to nothing.
class OneLibraryThread {
public:
    explicit OneLibraryThread(const LibraryThreads& threads);
    ~OneLibraryThread();
    OneLibraryThread(const OneLibraryThread&) = delete;
    OneLibraryThread& operator=(const OneLibraryThread&) = delete;

private:
    const LibraryThreads& threads_;
    int levels_ = 0;
};

}  // namespace fettle::core::linear
