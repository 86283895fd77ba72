// SPDX-License-Identifier: MIT
/// CHOLMOD's functions, loaded where the first large system is factorised (base/shared_library.hpp): with it come BLAS and OpenMP.
#pragma once

#include <cholmod.h>

namespace fettle::core::solver {

/// Each as cholmod.h declares it, without its "cholmod_".
struct CholmodLibrary {
    decltype(&cholmod_start) start;
    decltype(&cholmod_finish) finish;
    decltype(&cholmod_allocate_sparse) allocate_sparse;
    decltype(&cholmod_free_sparse) free_sparse;
    decltype(&cholmod_free_factor) free_factor;
    decltype(&cholmod_free_dense) free_dense;
    decltype(&cholmod_analyze) analyze;
    decltype(&cholmod_factorize) factorize;
    decltype(&cholmod_solve) solve;
};

/// Throws base::MissingLibrary.
const CholmodLibrary& cholmod_library();

}  // namespace fettle::core::solver
