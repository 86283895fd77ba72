// SPDX-License-Identifier: MIT
#include "fettle/core/solver/cholmod_library.hpp"

#include "fettle/core/base/shared_library.hpp"

namespace fettle::core::solver {
namespace {

CholmodLibrary load_cholmod() {
    CholmodLibrary out{};
#ifdef FETTLE_CHOLMOD_NAME
    const base::SharedLibrary library(FETTLE_CHOLMOD_NAME, FETTLE_CHOLMOD_PATH);
#define FETTLE_CHOLMOD(function) library.find("cholmod_" #function, out.function)
#else
#define FETTLE_CHOLMOD(function) out.function = &cholmod_##function
#endif
    FETTLE_CHOLMOD(start);
    FETTLE_CHOLMOD(finish);
    FETTLE_CHOLMOD(allocate_sparse);
    FETTLE_CHOLMOD(free_sparse);
    FETTLE_CHOLMOD(free_factor);
    FETTLE_CHOLMOD(free_dense);
    FETTLE_CHOLMOD(analyze);
    FETTLE_CHOLMOD(factorize);
    FETTLE_CHOLMOD(solve);
#undef FETTLE_CHOLMOD
    return out;
}

}  // namespace

const CholmodLibrary& cholmod_library() {
    static const CholmodLibrary library = load_cholmod();
    return library;
}

}  // namespace fettle::core::solver
