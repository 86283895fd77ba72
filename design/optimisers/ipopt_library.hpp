// SPDX-License-Identifier: MIT
/// Ipopt's C functions, loaded where they are first called (core/base/shared_library.hpp): with Ipopt come MUMPS, BLAS and more.
#pragma once

#include <IpStdCInterface.h>

#include "core/linear/library_threads.hpp"

namespace fettle::design::optimisers {

/// As IpStdCInterface.h declares them.
struct IpoptLibrary {
    decltype(&CreateIpoptProblem) create_problem;
    decltype(&FreeIpoptProblem) free_problem;
    decltype(&AddIpoptStrOption) add_string_option;
    decltype(&AddIpoptNumOption) add_number_option;
    decltype(&AddIpoptIntOption) add_integer_option;
    decltype(&SetIntermediateCallback) set_intermediate_callback;
    decltype(&IpoptSolve) solve;
    core::linear::LibraryThreads threads;  ///< of what it calls
};

/// Throws core::base::MissingLibrary.
const IpoptLibrary& ipopt_library();

}  // namespace fettle::design::optimisers
