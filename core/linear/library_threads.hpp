// SPDX-License-Identifier: MIT
/// SuiteSparse's dense work is done by a BLAS, and some of its loops by OpenMP. Both have threads of their own; fettle's are enough, and
/// the bits of an answer are not to depend on how many there are.
#pragma once

#include "core/base/shared_library.hpp"

namespace fettle::core::linear {

/// What a library's threads are set by; null: it has no such threads.
struct LibraryThreads {
    void (*set_blas)(int) = nullptr;  ///< OpenBLAS's; null: the BLAS is another one
    int (*blas)() = nullptr;
    void (*set_levels)(int) = nullptr;  ///< OpenMP's depth of parallel regions, of the calling thread
    int (*levels)() = nullptr;
    void (*rank_update)(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*, double*,
                        const int*) = nullptr;  ///< the BLAS's dsyrk; null where set_blas is
};

/// The threads of `library` and of those that it was linked with. @param library  null: of the whole program
LibraryThreads threads_of(const base::SharedLibrary* library);

/// OpenBLAS asks for 128 MB of addresses at its first call, and asks again for ever where the system refuses them. Once per thread this
/// finds out whether they are there, and lets OpenBLAS have them, which keeps them.
/// @throws std::bad_alloc  they are not there
void take_blas_buffer(const LibraryThreads& threads);

/// While it lives OpenBLAS works on one thread, for everybody (the last one to go puts back what was), and OpenMP's regions on the calling
/// thread alone. Costs next to nothing.
class OneLibraryThread {
public:
    /// @throws std::bad_alloc  as take_blas_buffer
    explicit OneLibraryThread(const LibraryThreads& threads);
    ~OneLibraryThread();
    OneLibraryThread(const OneLibraryThread&) = delete;
    OneLibraryThread& operator=(const OneLibraryThread&) = delete;

private:
    const LibraryThreads& threads_;
    int levels_ = 0;
};

}  // namespace fettle::core::linear
