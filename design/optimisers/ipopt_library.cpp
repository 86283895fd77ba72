// SPDX-License-Identifier: MIT
#include "design/optimisers/ipopt_library.hpp"

#include "core/base/shared_library.hpp"

namespace fettle::design::optimisers {

namespace {

IpoptLibrary load_ipopt() {
    IpoptLibrary out{};
#ifdef FETTLE_IPOPT_NAME
    const core::base::SharedLibrary library(FETTLE_IPOPT_NAME, FETTLE_IPOPT_PATH);
#define FETTLE_IPOPT(member, function) library.find(#function, out.member)
    out.threads = core::linear::threads_of(&library);
#else
    out.threads = core::linear::threads_of(nullptr);
#define FETTLE_IPOPT(member, function) out.member = &function
#endif
    FETTLE_IPOPT(create_problem, CreateIpoptProblem);
    FETTLE_IPOPT(free_problem, FreeIpoptProblem);
    FETTLE_IPOPT(add_string_option, AddIpoptStrOption);
    FETTLE_IPOPT(add_number_option, AddIpoptNumOption);
    FETTLE_IPOPT(add_integer_option, AddIpoptIntOption);
    FETTLE_IPOPT(set_intermediate_callback, SetIntermediateCallback);
    FETTLE_IPOPT(solve, IpoptSolve);
#undef FETTLE_IPOPT
    return out;
}

}  // namespace

const IpoptLibrary& ipopt_library() {
    static const IpoptLibrary library = load_ipopt();
    return library;
}

}  // namespace fettle::design::optimisers
